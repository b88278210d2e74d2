// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>

#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/safety/guard_options.hpp"

namespace chicane::safety {

/// One moment of a stop.
struct StopPoint {
  double time = 0.0;      ///< from which the command acts [s], clock of the run
  double distance = 0.0;  ///< driven since the plan began [m]
  double speed = 0.0;     ///< planned then [m/s]
  model::Command command;
};

/// A way to standstill on the known road, to be driven without any further measurement (docs/safety.md). Data
/// only; travels with each command to the receiver, which stops the car when commands cease.
struct StopPlan {
  static constexpr int kCapacity = 128;
  int size = 0;  ///< points in use, by rising time; 0: no plan
  std::array<StopPoint, kCapacity> points{};

  /// One more point; nothing where the plan is full.
  void add(const StopPoint& point) noexcept {
    if (size < kCapacity) points[static_cast<std::size_t>(size++)] = point;
  }
};
[[nodiscard]] inline std::unique_ptr<StopPlan> copy_of(const StopPlan& plan) {
  return std::make_unique<StopPlan>(plan);
}

/// What the actuators do `distance` [m] after a stop began, at `speed` [m/s] by their own wheels: the planned
/// steering of that place, and what meets the planned speed there again. Pre: stop.size > 0.
/// `from`: index of the point that acts there; the search begins from it, where it is not null.
[[nodiscard]] model::Command played(const StopPlan& stop, double distance, double speed,
                                    const model::VehicleParams& vehicle, int* from = nullptr) noexcept;

/// The receiver's side of a broken link: what the actuators do when commands cease. A watchdog at the sender
/// could not help. It knows the clock, its own wheel speed, and what has arrived; no position.
///
///     kStopPlan   the stop that came with the last command, by the distance driven since (docs/safety.md,
///     "The receiver");
///                 braking with the last steering where none came
///     kBrake      all useful braking with the last steering, after kPatience
///     kHold       the last command for ever, as the original simulator does
///
/// No allocation after construction; one thread.
class StopPlayer {
 public:
  // Chosen: six cycles of the simulator's 25 Hz, and at least three of any other.
  static constexpr double kPatience = 0.25;        ///< [s] without a stop plan
  static constexpr double kPatienceInPeriods = 3;  ///< where the control period is long

  StopPlayer(const model::VehicleParams& vehicle, double control_period, Receiver receiver) noexcept;

  /// A new run begins at time 0.
  void reset() noexcept;
  /// Without a stop plan the next command is waited for so long [s], at least kPatience.
  void set_patience(double patience) noexcept { patience_ = std::max(patience, kPatience); }
  /// A command acts from `time` [s] on, and `stop` holds when nothing comes after it.
  void arrived(double time, const StopPlan& stop) noexcept;
  /// What the actuators do at `time` [s]: `command`, the last that acts, or the stop. `speed` [m/s] is the
  /// actuators' own. Times do not decrease.
  [[nodiscard]] model::Command guard(const model::Command& command, double time, double speed) noexcept;
  /// The last guard() was not the command.
  [[nodiscard]] bool is_stopping() const noexcept { return is_stopping_; }

 private:
  struct Arrival {
    double time = 0.0;
    StopPlan stop;
  };
  static constexpr int kWaiting = 32;  ///< commands that wait: chosen, 1.3 s at 25 Hz

  [[nodiscard]] model::Command brake(const model::Command& command, double speed) const noexcept;

  model::VehicleParams vehicle_;
  double patience_;
  Receiver receiver_;
  std::array<Arrival, kWaiting> arrivals_{};  ///< ring, by rising time
  int first_ = 0;
  int count_ = 0;
  double last_time_ = 0.0;  ///< of the last guard() [s]
  double distance_ = 0.0;   ///< driven since the stop began [m]
  bool is_stopping_ = false;
};

}  // namespace chicane::safety
