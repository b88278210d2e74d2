// SPDX-License-Identifier: MIT
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

/// A fault that never ends: a duration beyond any run [s].
inline constexpr double kLasting = 1e6;

/// One fault, or two at once, at one moment of the flying lap.
struct FaultTrial {
  sim::Fault fault{};
  double onset = 0.0;     ///< time since the flying lap began [s]
  double duration = 1.0;  ///< [s]; kLasting: until the end of the run
  double strength = 1.0;
  std::optional<sim::Fault> second{};  ///< second fault at the same time, with its kind's strength
};

/// Outcome of a trial.
struct FaultOutcome {
  FaultTrial trial;
  double at = 0.0;     ///< start of the fault, clock of the run [s]: `--fault NAME@at` repeats it
  double until = 0.0;  ///< end of the trial [s]: `--set time_limit_s=` repeats it
  double least_edge = std::numeric_limits<double>::infinity();  ///< least tyre gap since [m]; < 0: off road
  double end_speed = 0.0;                                       ///< [m/s]
  int not_controller = 0;  ///< control steps that were not the controller's own answer
  [[nodiscard]] bool has_left_road() const noexcept { return least_edge < 0.0; }
  [[nodiscard]] bool stands() const noexcept { return end_speed < kStanding; }
  static constexpr double kStanding = 0.1;  ///< [m/s]
};

/// Time until a trial ends: kSettling after a fault that ends, otherwise until the car has stood for a
/// second, at most kLongestWait.
inline constexpr double kSettling = 10.0;     ///< [s]
inline constexpr double kLongestWait = 30.0;  ///< [s]
[[nodiscard]] constexpr double longest_trial(double duration) noexcept {
  return duration >= kLasting ? kLongestWait : duration + kSettling;
}

/// A stretch of a run with a tyre off the road, clock of the run [s].
struct Excursion {
  double from = 0.0, to = 0.0;
};
/// Start and duration of a scenario's flying lap, the second one, without a fault. On an open road: from
/// standstill to its end.
struct FlyingLap {
  double begins = 0.0;           ///< clock of the run [s]
  double time = 0.0;             ///< [s]
  std::vector<Excursion> off{};  ///< places where the car leaves the road without any fault
  [[nodiscard]] bool is_off_within(double from, double to) const noexcept;
};
/// Drives the scenario without a fault, for `wait` [s] longer than the flying lap. kInvalidArgument when two
/// laps, or an open road, are not driven in half an hour.
[[nodiscard]] Result<FlyingLap> drive_undisturbed(const scenario::Scenario& scenario,
                                                  double wait = kLongestWait, const Factories& make = {});
/// Drives trials of `scenario` without its own faults, each from the start of a run. Deterministic; no trial
/// depends on others. The time before a fault is driven once for all: from its onset on a trial is a copy of
/// the run, on at most `jobs` threads. The outcomes are in the order of the trials, whatever the number of
/// threads. `on_done` gets how many are done, from one thread at a time; false ends early, with the outcomes
/// so far (a trial that was not driven has an infinite least_edge). kInvalidArgument where the run cannot be
/// copied (ClosedLoop::copy()).
[[nodiscard]] Result<std::vector<FaultOutcome>> drive_trials(
    const scenario::Scenario& scenario, const FlyingLap& lap, const std::vector<FaultTrial>& trials, int jobs,
    const std::function<bool(std::size_t)>& on_done = {}, const Factories& make = {});
}  // namespace chicane::run
