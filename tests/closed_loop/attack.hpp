// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/run/closed_loop.hpp"
#include "closed_loop/adversaries.hpp"
#include "closed_loop/false_signals.hpp"

/// Trials of the guard against adversaries and false signals: each in a process of its own.
namespace chicane::attack {

/// What became of the car. Times are since the attack may begin.
struct Outcome {
  bool is_there = false;  ///< false: the process of the trial crashed, or the trial was not driven
  double least_edge = std::numeric_limits<double>::infinity();  ///< of a tyre [m]; < 0: off the road
  double least_at = 0.0;                                        ///< [s], clock of the run
  double fastest = 0.0;                                         ///< [m/s]
  double end_speed = 0.0;                                       ///< [m/s]
  double doubted_after =
      std::numeric_limits<double>::quiet_NaN();  ///< first doubt of a sensor or an actuator [s]; NaN: none
  double acted_after = std::numeric_limits<double>::quiet_NaN();  ///< the guard's first own command [s]
  double driving_after =
      std::numeric_limits<double>::quiet_NaN();  ///< faster than kDriving for the first time [s]
  controller::GuardReason doubt = controller::GuardReason::kNone;  ///< the first one
  [[nodiscard]] bool has_left_road() const { return !is_there || least_edge < 0.0; }

  static constexpr double kDriving = 2.0;   ///< [m/s] of a car in full size
  static constexpr double kStanding = 0.1;  ///< [m/s]
};

/// Where an attack is driven: names of car, track and preset, and further settings by their keys.
struct Place {
  std::string car = "udacity", track = "lakeside", preset = "default";
  std::vector<std::pair<std::string, std::string>> settings{};
};
/// A run without end.
[[nodiscard]] Result<scenario::Scenario> scenario_of(const Place& place);

/// Told each control step of a trial.
using OnFrame = std::function<void(const telemetry::Frame&)>;

/// Drives to `until` [s], clock of the run.
[[nodiscard]] Outcome watch(run::ClosedLoop& loop, double until, const OnFrame& on_frame = {});

/// One adversary from the start of the run on.
[[nodiscard]] Result<Outcome> drive_adversary(const scenario::Scenario& scenario, run::Roads& roads,
                                              const AdversaryKind& kind, std::uint64_t seed, double seconds,
                                              const OnFrame& on_frame = {});

/// A false signal at one moment of a run.
struct SignalTrial {
  FalseSignal signal{};
  double onset = 0.0;     ///< [s], clock of the run
  double duration = 2.0;  ///< [s]; kLasting: to the end
  std::uint64_t seed = 1;
};
inline constexpr double kLasting = 1e6;      ///< [s]
inline constexpr double kAfterwards = 20.0;  ///< a trial goes on after a signal that ends [s]
inline constexpr double kLongest = 40.0;     ///< and with one that lasts [s]

/// Drives the trial, of which everything before the onset has been driven in `loop`.
[[nodiscard]] Outcome drive_signal(run::ClosedLoop& loop, const SignalTrial& trial,
                                   std::shared_ptr<SignalMemory> memory, const OnFrame& on_frame = {});

/// Calls work(i) for i in [0, count) in copies of this process, at most `jobs` at a time; i rises. prepare(i)
/// is called in this process before. on_done is told of each outcome, in the order of i.
void drive_in_processes(std::size_t count, int jobs, const std::function<void(std::size_t)>& prepare,
                        const std::function<Outcome(std::size_t)>& work,
                        const std::function<void(std::size_t, const Outcome&)>& on_done);

}  // namespace chicane::attack
