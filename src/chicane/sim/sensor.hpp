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

namespace chicane::sim {

/// Errors between the plant and a controller's measurement. Zero means perfect.
struct SensorOptions {
  double position_noise = 0.0;    ///< standard deviation of x and y [m]
  double heading_noise = 0.0;     ///< [rad]
  double speed_noise = 0.0;       ///< [m/s]
  double position_quantum = 0.0;  ///< x and y are rounded to multiples of it [m]
  double heading_quantum = 0.0;   ///< [rad]
  double speed_quantum = 0.0;     ///< [m/s]
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
  [[nodiscard]] model::Measurement sample(double time, const Plant& plant) noexcept;

 private:
  /// Observable state at a moment.
  struct Sight {
    double time = 0.0, x = 0.0, y = 0.0, psi = 0.0, speed = 0.0, steer = 0.0, throttle = 0.0;
  };
  static constexpr std::size_t kRemembered = 128;  ///< the longest latency, sampled each 4 ms
  [[nodiscard]] Sight seen_at(double time) const noexcept;

  SensorOptions options_;
  Random random_;
  std::array<Sight, kRemembered> sights_{};  ///< a ring
  std::size_t count_ = 0;                    ///< samples so far
};

/// Commands on their way to the actuators: each acts from its own time on, until a later one does. Any delay,
/// not only multiples of a step. Fixed memory: when full, the oldest waiting command is dropped in favour of
/// the next.
class ActuationDelay {
 public:
  void reset(const model::Command& acting) noexcept;
  /// `command` acts from `time` [s] on. Times must not decrease; a decreasing one is raised to the last.
  void push(double time, const model::Command& command) noexcept;
  /// Time at which the last waiting command will act [s]; minus infinity if none waits.
  [[nodiscard]] double last_time() const noexcept;
  /// The command acting at `time` [s]. Times must not decrease from call to call.
  [[nodiscard]] const model::Command& at(double time) noexcept;

 private:
  struct Entry {
    double time = 0.0;
    model::Command command;
  };
  static constexpr int kCapacity = 128;  ///< commands in flight
  std::array<Entry, kCapacity> waiting_{};
  int first_ = 0;
  int count_ = 0;
  model::Command acting_;
};

/// Random delay of a command sent at `time` [s]: evenly distributed in [0, most) [s]. A function of seed and
/// time alone, so that a branched run continues unchanged.
[[nodiscard]] double random_delay(std::uint64_t seed, double time, double most) noexcept;

}  // namespace chicane::sim
