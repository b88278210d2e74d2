// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "chicane/identify/detail/four_wheels.hpp"
#include "chicane/identify/drive_log.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::identify {

/// A car as it is fitted: the controllers' model, and what lies between a command and the car.
struct Car {
  model::VehicleParams vehicle;
  double delay = 0.1;         ///< from command to effect [s]
  double steer_offset = 0.0;  ///< of the road-wheel angle beyond what was commanded [rad]
  double reference = 0.0;     ///< the log's reference point ahead of the centre of mass [m]
  Wheels wheels{};            ///< used where has_four_wheels()
};

/// Steering and drive of a log, on a grid: they need the commands and measured speeds alone.
class Actuators {
 public:
  static constexpr double kStep = 0.01;  ///< of the grid [s]

  Actuators(const DriveLog& log, const Car& car);
  [[nodiscard]] double start() const noexcept { return start_; }
  [[nodiscard]] std::size_t size() const noexcept { return steer_.size(); }
  /// At grid point `i`, and means of what is asked over the step from there.
  [[nodiscard]] double steer(std::size_t i) const noexcept { return steer_[i]; }
  [[nodiscard]] double steer_mean(std::size_t i) const noexcept { return steer_mean_[i]; }
  [[nodiscard]] double acceleration(std::size_t i) const noexcept { return acceleration_[i]; }
  [[nodiscard]] double throttle(std::size_t i) const noexcept { return throttle_[i]; }
  [[nodiscard]] double pedal(std::size_t i) const noexcept { return pedal_[i]; }  ///< after its lag
  [[nodiscard]] double speed(std::size_t i) const noexcept { return speed_[i]; }  ///< as measured

 private:
  double start_;
  std::vector<double> steer_, steer_mean_, acceleration_, throttle_, pedal_, speed_;
};

/// Where a window begins: x, y [m], psi [rad], vx, vy [m/s], r [rad/s].
using Start = std::array<double, 6>;
/// What a log would have measured: x, y of the reference point, psi, speed, r; then what it would not: vx, vy
/// and the road-wheel angle.
using Expected = std::array<double, 8>;

/// Drives the car from `start` at the time of sample `first`: what samples first … last - 1 would be.
void drive(const Car& car, const DriveLog& log, const Actuators& actuators, std::size_t first,
           std::size_t last, const Start& start, std::vector<Expected>& expected);

}  // namespace chicane::identify
