// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "chicane/base/option.hpp"
#include "chicane/base/random.hpp"
#include "chicane/model/state.hpp"
#include "chicane/sim/plant.hpp"

/// Signals between plant and controller: the sensor, and the delay of commands.

namespace chicane::sim {

/// Errors between the plant and a controller's measurement. Zero means perfect.
struct SensorOptions {
  double position_noise = 0.0;    ///< standard deviation of x and y [m]
  double heading_noise = 0.0;     ///< standard deviation of the yaw [rad]
  double speed_noise = 0.0;       ///< standard deviation of the speed [m/s]
  double position_quantum = 0.0;  ///< step to whose multiples x and y are rounded [m]
  double heading_quantum = 0.0;   ///< step to whose multiples the yaw is rounded [rad]
  double speed_quantum = 0.0;     ///< step to whose multiples the speed is rounded [m/s]
  double latency = 0.0;           ///< age of a measurement when the controller gets it, unknown to it [s]

  friend bool operator==(const SensorOptions&, const SensorOptions&) = default;
};
/// The fields with their units and ranges, for files and messages.
[[nodiscard]] std::span<const Option> sensor_options() noexcept;

/// Samples the plant as telemetry does; seeded and deterministic. Fills everything but waypoints and delay.
///
/// With a latency the content is older by it, interpolated linearly between sampled moments (error 4 mm at 30
/// m/s in a bend of 50 m with samples 40 ms apart), or the oldest sample if none is old enough. The time is
/// always the call's, as in telemetry without time stamps.
class Sensor {
 public:
  Sensor(const SensorOptions& options, std::uint64_t seed) noexcept : options_{options}, random_{seed} {}
  /// Applies other options from now on; the stream of random numbers continues.
  void configure(const SensorOptions& options) noexcept { options_ = options; }
  /// Measurement of the plant at `time` [s].
  [[nodiscard]] model::Measurement sample(double time, const Plant& plant) noexcept;

 private:
  /// True values of the measured quantities at a moment.
  struct Sight {
    double time = 0.0, x = 0.0, y = 0.0, psi = 0.0, speed = 0.0, steer = 0.0, throttle = 0.0;
  };
  static constexpr std::size_t kRemembered = 128;  ///< derived from the longest latency: 500 ms / 4 ms
  /// True values at `time` [s], by interpolation.
  [[nodiscard]] Sight seen_at(double time) const noexcept;

  SensorOptions options_;
  Random random_;
  std::array<Sight, kRemembered> sights_{};  ///< ring of the last samples
  std::size_t count_ = 0;                    ///< samples so far
};

/// Commands on their way to the actuators. Each acts from its own time on until a later one does; delays need
/// not be multiples of a step. Fixed memory: when it is full, the oldest waiting command is dropped.
class ActuationDelay {
 public:
  /// Drops the waiting commands; `acting` acts.
  void reset(const model::Command& acting) noexcept;
  /// `command` acts from `time` [s] on. Times must not decrease; a decreasing one is raised to the last.
  void push(double time, const model::Command& command) noexcept;
  /// Time at which the last waiting command will act [s]; minus infinity if none waits.
  [[nodiscard]] double last_time() const noexcept;
  /// The command acting at `time` [s]. Times must not decrease from call to call.
  [[nodiscard]] const model::Command& at(double time) noexcept;

 private:
  struct Entry {
    double time = 0.0;  ///< time from which the command acts [s]
    model::Command command;
  };
  static constexpr std::size_t kCapacity = 128;  ///< commands in flight; chosen: 128 · 4 ms = 0.5 s
  std::array<Entry, kCapacity> waiting_{};       ///< ascending in time
  std::size_t count_ = 0;                        ///< waiting commands
  model::Command acting_;
};

/// Random delay of a command sent at `time` [s]: evenly distributed in [0, most) [s]. A function of seed and
/// time alone, so that a branched run continues unchanged.
[[nodiscard]] double random_delay(std::uint64_t seed, double time, double most) noexcept;

}  // namespace chicane::sim
