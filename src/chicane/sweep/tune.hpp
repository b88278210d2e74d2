// SPDX-License-Identifier: MIT
// Tuning: searches the numbers of a preset, such as weights, for the best objective with clean trials.
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

/// Objective: a fast lap, gentle steering, or distance to the road's edges.
enum class Objective { kLap, kComfort, kRobust };
/// Optimiser of NLopt: controlled random search, DIRECT_L, or Subplex.
enum class Optimizer { kCrs, kDirect, kSbplx };
inline constexpr std::array<std::string_view, 3> kObjectiveNames{"lap", "comfort", "robust"};
inline constexpr std::array<std::string_view, 3> kOptimizerNames{"crs", "direct", "sbplx"};

/// Task of a tuning, and its objective.
struct TuneTask {
  Settings settings{};              ///< settings of all trials: preset, car, track
  std::vector<std::string> over{};  ///< keys of the numbers to tune; empty: default_keys()
  Objective objective = Objective::kLap;
  Optimizer optimizer = Optimizer::kCrs;
  int evaluations = 500;   ///< number of different tunings to try; fewer if the search finds no new ones
  std::uint64_t seed = 1;  ///< seed of the random search
  int jobs = 1;            ///< number of threads
  std::string log{};       ///< file with a line for each evaluation; continued if it exists. Empty: none
};

/// A trial: settings in addition to the task's and the tuning's.
struct TuneTrial {
  std::string_view name;
  Settings settings{};
};
/// The trials of a tuning, two laps from standstill each: unchanged, with 30 ms more and less latency than
/// `latency` [s], with 10 % less grip, and twice with 5 cm of noise on the measured position.
[[nodiscard]] std::vector<TuneTrial> tune_trials(double latency);

/// Result of the trials of a tuning. The tuning by hand, which the preset has, drives all trials. Any other
/// tuning ends with the first trial that it does not pass: a tyre leaves the road (the run ends there), the
/// run takes half as long again as by hand, or margin or objective are worse than by hand.
struct Verdict {
  double lap_time = 0.0;       ///< flying lap of the first trial [s]; NaN: not completed
  double margin = 0.0;         ///< least distance from a tyre to the road's edge in the driven trials [m]
  double steering_rate = 0.0;  ///< root mean square of the steering rate in the first trial [rad/s]
  double progress = 0.0;       ///< distance of the last driven trial over the distance by hand, at most 1
  int off_track_events = 0;    ///< count in the driven trials
  int unfinished = 0;          ///< number of driven trials without all laps
  int driven = 0;              ///< number of driven trials
  int passed = 0;              ///< number of passed trials
  [[nodiscard]] bool is_clean() const noexcept { return off_track_events == 0 && unfinished == 0; }

  /// Calls `row` with the key in JSON and the member of each number. `Self`: Verdict, const or not.
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

/// Result of tune().
struct Tuning {
  Settings values{};           ///< best values of the tuned keys
  Verdict by_hand{}, found{};  ///< verdicts on the preset's values and on the best ones
  bool is_better = false;      ///< better than by hand: clean, with a better objective and no less margin
  int evaluations = 0;         ///< number of different tunings
  std::int64_t runs = 0;       ///< number of runs of all evaluations, those from the log included
};

/// Keys of the weights, horizon and speeds of the scenario's controller that are numbers above zero.
[[nodiscard]] std::vector<std::string> default_keys(const scenario::Scenario& scenario);

/// Searches weights from a tenth to ten times their value, other numbers from half to twice, inside their
/// ranges. A tuning that passes every trial is better than one that fails, and a later failure is better than
/// an earlier one. The optimisers use nothing but this order, so the trials after a failure need not be
/// driven. Deterministic for a seed, also if a log is continued. Ends early with the best so far when `stop`
/// is set. `on_evaluation`: called with the number of each evaluation, and its verdict if it is the best so
/// far, else null. kInvalidArgument for keys that are no numbers, and for the log of another task or program;
/// kIo in a build without NLopt, or if the log cannot be written.
[[nodiscard]] Result<Tuning> tune(const TuneTask& task, const std::atomic<bool>& stop,
                                  const std::function<void(int, const Verdict*)>& on_evaluation = {});

}  // namespace chicane::sweep
