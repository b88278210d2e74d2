// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "chicane/model/measurement.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::model {

/// A model car and the same car in full size (docs/cars.md, "Model cars"). With lengths by λ = 1 / scale and
/// times by √λ, speeds are by √λ, accelerations stay, and with forces by λ³ so do friction and gravity: the
/// two move alike. What controllers and guard hold in metres and seconds is stated for the car in full size;
/// a model car is seen by them as that. Factors are exactly 1 where the scale is.
class Similarity {
 public:
  explicit Similarity(double scale = 1.0) noexcept : length_{1.0 / scale}, time_{std::sqrt(1.0 / scale)} {}
  explicit Similarity(const VehicleParams& car) noexcept : Similarity{car.scale} {}

  [[nodiscard]] bool is_identity() const noexcept { return length_ == 1.0; }
  [[nodiscard]] double length() const noexcept { return length_; }  ///< in full size over that of the model
  [[nodiscard]] double time() const noexcept { return time_; }
  [[nodiscard]] double speed() const noexcept { return time_; }

  /// The car in full size; its own scale is 1. Ratios, angles and accelerations stay.
  [[nodiscard]] VehicleParams full_size(VehicleParams car) const noexcept {
    for (double* length : {&car.front_axle, &car.rear_axle, &car.track_width, &car.tire_width, &car.length,
                           &car.width, &car.kinematic_length, &car.height})
      *length *= length_;
    const double mass = length_ * length_ * length_;
    car.scale = 1.0;
    car.mass *= mass;
    car.yaw_inertia *= mass * length_ * length_;
    car.steer_rate_limit /= time_;
    car.steer_lag *= time_;
    car.drive_lag *= time_;
    car.helper_gap *= time_;
    car.load_per_speed /= speed();
    car.load_quadratic /= length_;
    car.drive_power_per_mass *= speed();
    car.valid_speed *= speed();
    car.drag_linear /= time_;
    car.drag_quadratic /= length_;
    car.reverse_speed *= speed();
    car.brake_latch_speed *= speed();
    return car;
  }

  /// The measurement for the controller of the car in full size.
  [[nodiscard]] Measurement full_size(Measurement seen) const noexcept {
    seen.time *= time_;
    seen.x *= length_;
    seen.y *= length_;
    seen.speed *= speed();
    seen.delay *= time_;
    for (int i = 0; i < seen.waypoint_count; ++i) seen.waypoints[static_cast<std::size_t>(i)] *= length_;
    return seen;
  }

 private:
  double length_;
  double time_;
};

}  // namespace chicane::model
