// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "chicane/base/option.hpp"
#include "chicane/base/random.hpp"
#include "chicane/model/measurement.hpp"
#include "chicane/sim/plant.hpp"

namespace chicane::sim {

/// What stands between the plant and what a controller is told. Zero means perfect.
struct SensorOptions {
  double position_noise = 0.0;    ///< standard deviation of x and y [m]
  double heading_noise = 0.0;     ///< [rad]
  double speed_noise = 0.0;       ///< [m/s]
  double position_quantum = 0.0;  ///< x and y are rounded to multiples of it [m]
  double heading_quantum = 0.0;   ///< [rad]
  double speed_quantum = 0.0;     ///< [m/s]
};
/// The fields with their units and ranges, for files and messages.
[[nodiscard]] std::span<const Option> sensor_options() noexcept;

/// Samples the plant as telemetry does; seeded and deterministic. Fills everything but waypoints and delay.
class Sensor {
 public:
  Sensor(const SensorOptions& options, std::uint64_t seed) noexcept : options_{options}, random_{seed} {}
  /// Other options from now on; the stream of random numbers goes on.
  void configure(const SensorOptions& options) noexcept { options_ = options; }
  [[nodiscard]] model::Measurement sample(double time, const Plant& plant) noexcept;

 private:
  SensorOptions options_;
  Random random_;
};

}  // namespace chicane::sim
