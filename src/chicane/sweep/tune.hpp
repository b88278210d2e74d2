// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/sweep/plan.hpp"

namespace chicane::sweep {

enum class Objective { kLap, kComfort, kRobust };
enum class Optimizer { kCrs, kDirect, kSbplx };
inline constexpr std::array<std::string_view, 3> kObjectiveNames{"lap", "comfort", "robust"};
inline constexpr std::array<std::string_view, 3> kOptimizerNames{"crs", "direct", "sbplx"};

/// What is tuned, and how it is judged.
struct TuneTask {
  Settings settings{};              ///< preset, car, track and what else stays
  std::vector<std::string> over{};  ///< keys of numbers to change; empty: default_keys()
  Objective objective = Objective::kLap;
  Optimizer optimizer = Optimizer::kCrs;  ///< NLopt's controlled random search, DIRECT_L, or Subplex
  int evaluations = 500;
  std::uint64_t seed = 1;
  int jobs = 1;
};

/// What a tuning does in all trials: two laps from standstill at the nominal car, with 30 ms more and less
/// latency, with 10 % less grip, and with noise on the measured position.
struct Verdict {
  double lap_time = 0.0;       ///< flying lap of the nominal car [s]; not-a-number: not completed
  double margin = 0.0;         ///< least distance of a tyre to the edge in all trials [m]
  double steering_rate = 0.0;  ///< rms of the nominal car [rad/s]
  int off_track_events = 0;    ///< in all trials
  int unfinished = 0;          ///< trials
  [[nodiscard]] bool is_clean() const noexcept { return off_track_events == 0 && unfinished == 0; }
};

struct Tuning {
  Settings values{};  ///< of the keys that were changed
  Verdict by_hand{}, found{};
  bool is_better = false;  ///< than by hand: clean, and by its objective with no less margin
  int evaluations = 0;
};

/// The weights, horizon and speed of the scenario's controller, as far as they are numbers above zero.
[[nodiscard]] std::vector<std::string> default_keys(const scenario::Scenario& scenario);

/// Searches each key from a tenth to ten times its value, speeds and horizons from half to twice, inside its
/// range. A tuning that leaves the road in any trial, or has less margin than the one by hand, is worse than
/// all that do not. Deterministic for a seed. Ends early with the best so far when `stop` is set. `on_better`
/// hears each improvement. kInvalidArgument for keys that are no numbers; kIo where this was built without
/// NLopt.
[[nodiscard]] Result<Tuning> tune(const TuneTask& task, const std::atomic<bool>& stop,
                                  const std::function<void(int, const Verdict&)>& on_better = {});

}  // namespace chicane::sweep
