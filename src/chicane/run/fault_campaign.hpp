// SPDX-License-Identifier: MIT
// Trials of faults at many moments of a flying lap: where each leaves the car.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/run/make.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/sim/fault.hpp"

namespace chicane::run {

/// Duration of a fault that never ends [s]: beyond any run.
inline constexpr double kLasting = 1e6;

/// One fault, or two at the same time, at one moment of the flying lap.
struct FaultTrial {
  sim::Fault fault{};
  double onset = 0.0;                  ///< time since the flying lap began [s]
  double duration = 1.0;               ///< [s]; kLasting: until the end of the run
  double strength = 1.0;               ///< strength of `fault`, in the unit of its kind (sim/fault.hpp)
  std::optional<sim::Fault> second{};  ///< second fault at the same time, with its kind's strength
};

/// Outcome of a trial.
struct FaultOutcome {
  FaultTrial trial;
  double at = 0.0;     ///< start of the fault, clock of the run [s]: `--fault NAME@at` repeats it
  double until = 0.0;  ///< end of the trial [s]: `--set time_limit_s=` repeats it
  /// Smallest distance of a tyre to the road's edge since the start of the fault [m]; < 0: off the road.
  double least_edge = std::numeric_limits<double>::infinity();
  double end_speed = 0.0;  ///< true speed at the end of the trial [m/s]; 0 for a run without a true state
  int not_controller = 0;  ///< control steps in which another command than the controller's was sent
  [[nodiscard]] bool has_left_road() const noexcept { return least_edge < 0.0; }
  [[nodiscard]] bool stands() const noexcept { return end_speed < kStanding; }
  static constexpr double kStanding = 0.1;  ///< speed below which the car stands [m/s]; chosen
};

/// Time for which a trial continues after a fault that ends [s]; chosen.
inline constexpr double kSettling = 10.0;
/// Longest time after the start of a fault that lasts [s]. Chosen: longer than any stop. The trial
/// ends earlier, but not in its first 5 s, once the car has stood for a second.
inline constexpr double kLongestWait = 30.0;

/// Longest time from the start of a fault of this `duration` [s] to the trial's end [s].
[[nodiscard]] constexpr double longest_trial(double duration) noexcept {
  return duration >= kLasting ? kLongestWait : duration + kSettling;
}

/// Stretch of a run with a tyre off the road, by the clock of the run [s].
struct Excursion {
  double from = 0.0, to = 0.0;
};

/// The flying lap of a scenario without faults: its second lap. On an open road: from standstill to the end.
struct FlyingLap {
  double begins = 0.0;           ///< start, by the clock of the run [s]
  double time = 0.0;             ///< lap time [s]
  std::vector<Excursion> off{};  ///< stretches off the road without any fault
  /// Whether the car is off the road at any time in [from, to], by the clock of the run [s].
  [[nodiscard]] bool is_off_within(double from, double to) const noexcept;
};

/// Drives the scenario without a fault, and for `wait` [s] on after the flying lap. kInvalidArgument when two
/// laps, or an open road, are not driven in half an hour.
[[nodiscard]] Result<FlyingLap> drive_undisturbed(const scenario::Scenario& scenario,
                                                  double wait = kLongestWait, const Factories& make = {});

/// Drives trials of `scenario` without the scenario's own faults. The time before the faults is driven once:
/// at the onset of its fault each trial continues a copy of the run, on at most `jobs` threads.
/// Deterministic; no trial depends on others; outcomes are in the order of the trials. `on_done` gets the
/// number of trials done, from one thread at a time; false ends early with the outcomes so far (a trial that
/// was not driven has an infinite least_edge). kInvalidArgument if the run cannot be copied
/// (ClosedLoop::copy()).
[[nodiscard]] Result<std::vector<FaultOutcome>> drive_trials(
    const scenario::Scenario& scenario, const FlyingLap& lap, const std::vector<FaultTrial>& trials, int jobs,
    const std::function<bool(std::size_t)>& on_done = {}, const Factories& make = {});

}  // namespace chicane::run
