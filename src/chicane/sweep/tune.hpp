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

/// Task of a tuning, and its objective.
struct TuneTask {
  Settings settings{};              ///< preset, car, track and what else stays
  std::vector<std::string> over{};  ///< keys of numbers to change; empty: default_keys()
  Objective objective = Objective::kLap;
  Optimizer optimizer = Optimizer::kCrs;  ///< NLopt's controlled random search, DIRECT_L, or Subplex
  int evaluations = 500;  ///< different tunings to try, but for a search that finds no new ones
  std::uint64_t seed = 1;
  int jobs = 1;
  std::string log{};  ///< file with a line for each evaluation; continued if it exists. Empty: none
};

/// A trial: settings in addition to the task's and the tuning's.
struct TuneTrial {
  std::string_view name;
  Settings settings{};
};
/// The trials of a tuning, two laps from standstill each: unchanged, with 30 ms more and less latency than
/// `latency` [s], with 10 % less grip, and twice with 5 cm of noise on the measured position.
[[nodiscard]] std::vector<TuneTrial> tune_trials(double latency);

/// Result of a tuning's trials. The tuning by hand is driven in all of them. Another one is dropped after the
/// first trial that shows that it cannot win: a tyre leaves the road (the run ends there), it takes half as
/// long again as by hand, its margin is below the one by hand, or its objective is already worse.
struct Verdict {
  double lap_time = 0.0;       ///< flying lap of the first trial [s]; not-a-number: not completed
  double margin = 0.0;         ///< least distance of a tyre to the edge in the trials driven [m]
  double steering_rate = 0.0;  ///< rms of the first trial [rad/s]
  double progress = 0.0;       ///< progress of the last trial, over the way driven by hand, up to 1
  int off_track_events = 0;    ///< count in the trials driven
  int unfinished = 0;          ///< count of the trials driven
  int driven = 0;              ///< trials
  int passed = 0;              ///< trials
  [[nodiscard]] bool is_clean() const noexcept { return off_track_events == 0 && unfinished == 0; }

  /// Tells `row` the name in JSON and the place of each number. `Self`: Verdict, const or not.
  template <class Self, class Row>
  static void rows(Self& verdict, Row&& row) {
    row("lap_time_s", verdict.lap_time);
    row("margin_m", verdict.margin);
    row("steering_rate_radps", verdict.steering_rate);
    row("progress", verdict.progress);
    row("off_track_events", verdict.off_track_events);
    row("unfinished", verdict.unfinished);
    row("driven", verdict.driven);
    row("passed", verdict.passed);
  }
};

struct Tuning {
  Settings values{};  ///< values of the changed keys
  Verdict by_hand{}, found{};
  bool is_better = false;  ///< better than by hand: clean, with a better objective and no less margin
  int evaluations = 0;
  std::int64_t runs = 0;  ///< runs of all evaluations, those from the log included
};

/// The weights, horizon and speed of the scenario's controller, as far as they are numbers above zero.
[[nodiscard]] std::vector<std::string> default_keys(const scenario::Scenario& scenario);

/// Searches each key from a tenth to ten times its value, speeds and horizons from half to twice, inside its
/// range. A tuning that passes every trial is better than one that fails, and a later failure is better than
/// an earlier one. The optimisers need this order alone, so that a losing tuning's remaining trials are not
/// driven. Deterministic for a seed, also when a log is continued. Ends early with the best so far when
/// `stop` is set. `on_evaluation` gets each evaluation, and its verdict where it is the best so far.
/// kInvalidArgument for keys that are no numbers and for a log of another task or program; kIo where this was
/// built without NLopt or the log cannot be written.
[[nodiscard]] Result<Tuning> tune(const TuneTask& task, const std::atomic<bool>& stop,
                                  const std::function<void(int, const Verdict*)>& on_evaluation = {});

}  // namespace chicane::sweep
