// SPDX-License-Identifier: MIT
// Motion of the car that is identified: a four-wheel car, the steering and drive between command and car, and
// the prediction of samples (docs/identification.md, eq. 3 to 5).
#pragma once

#include <array>
#include <vector>

#include "chicane/identify/drive_log.hpp"
#include "chicane/identify/identification.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/model/wheel_forces.hpp"

namespace chicane::identify {

/// Four-wheel car for the fit (docs/identification.md, eq. 3, 4). It has the forces of the controllers'
/// model, and effects that a log near the limit shows beyond it: tyres build up force over a distance, load
/// moves with a lag, angles are not small. No allocation.
///
/// Pre: a tyre of the magic formula, no steering helper (has_four_wheels()).
class FourWheels {
 public:
  /// Motion of the car at a moment. Slips and load transfer are half a step older. Wheels are in the order
  /// front left, front right, rear left, rear right.
  struct Motion {
    double vx = 0.0, vy = 0.0;             ///< velocity of the centre of mass in the car's axes [m/s]
    double r = 0.0;                        ///< yaw rate [rad/s]
    std::array<double, 4> slip{};          ///< slip across the wheel
    std::array<double, 4> slip_along{};    ///< slip along the wheel in the last step, forward positive
    std::array<double, 4> rolling{};       ///< forward speeds of the wheels' centres in the last step [m/s]
    double along = 0.0, across = 0.0;      ///< lagged accelerations that transfer load [m/s²]
    double resistance = 0.0;               ///< deceleration by turned front wheels in the last step [m/s²]
    double forward = 0.0, sideways = 0.0;  ///< acceleration by all forces in the last step [m/s²]
  };

  /// `dt`: length of a step [s].

  FourWheels(const model::VehicleParams& vehicle, const Wheels& wheels, double dt) noexcept;

  /// Motion of a car that has driven with these velocities, steering angle [rad] and forward acceleration
  /// [m/s²] for a while.
  [[nodiscard]] Motion steady(double vx, double vy, double r, double steer,
                              double acceleration) const noexcept;
  /// Moves the car by one step. `steer`, `steer_middle`: road-wheel angles at the start and in the middle of
  /// the step [rad]; `force`: demand of drive and brakes on all wheels over mass, `drag`: other resistances
  /// over mass [m/s²].
  void advance(Motion& motion, double steer, double steer_middle, double force, double drag) const noexcept;

 private:
  /// Tyre of an axle. Load transfer is in shares of the load at rest for each m/s² of acceleration.
  struct Tire {
    double cornering;   ///< stiffness over friction
    double per_along;   ///< load transfer by acceleration along the car
    double per_across;  ///< load transfer by acceleration across the car
  };

  model::VehicleParams vehicle_;
  double dt_;              ///< length of a step [s]
  double per_relaxation_;  ///< one over the relaxation length [1/m]
  double load_share_;      ///< share of the way to the new load transfer in one step
  Wheels wheels_;
  double rotating_;  ///< Wheels::rotating
  double inertia_;   ///< wheel inertia over (squared radius · mass of the car)
  double turn_;      ///< mass over yaw inertia [1/m²]
  std::array<model::Axle, 2> axles_;
  std::array<Tire, 2> tires_{};  ///< tyres of front and rear axle
};

/// Whether FourWheels can represent a car; else the fit uses the controllers' single-track model.
[[nodiscard]] inline bool has_four_wheels(const model::VehicleParams& vehicle) noexcept {
  return vehicle.steer_helper == 0.0 && vehicle.tire_shape > 1.0 && vehicle.friction_coupling > 0.0;
}

/// Car of the fit: the controllers' model, and what lies between a command and the car.
struct Car {
  model::VehicleParams vehicle;
  double delay = 0.1;         ///< time from command to effect [s]
  double steer_offset = 0.0;  ///< road-wheel angle beyond the commanded one [rad]
  double reference = 0.0;     ///< distance of the log's reference point ahead of the centre of mass [m]
  Wheels wheels{};            ///< used if has_four_wheels()
};

/// Steering and drive of a log on a grid of time. They depend on the commands and the measured speeds alone.
class Actuators {
  /// Step of the grid [s]: a tenth of the fastest lags; chosen.
 public:
  static constexpr double kStep = 0.01;

  /// Inputs of the car at a point of the grid.
  struct Point {
    double steer;         ///< steering angle without the offset [rad]
    double steer_mean;    ///< mean of the steering angle over the step from here [rad]
    double acceleration;  ///< along the car, after the lag of the drive [m/s²]
    double throttle;      ///< mean of the commanded pedal over the step from here
    double pedal;         ///< pedal after the lag of the drive
    double speed;         ///< measured speed [m/s]
  };

  Actuators(const DriveLog& log, const Car& car);
  [[nodiscard]] double start() const noexcept { return start_; }              ///< time of grid point 0 [s]
  [[nodiscard]] std::size_t size() const noexcept { return points_.size(); }  ///< number of grid points
  /// Grid point nearest to time `t` [s]: with the one before it commands would act up to a step too late.
  [[nodiscard]] std::size_t nearest(double t) const noexcept {
    return static_cast<std::size_t>((t - start_) / kStep + 0.5);
  }
  [[nodiscard]] const Point& operator[](std::size_t i) const noexcept { return points_[i]; }

 private:
  double start_;
  std::vector<Point> points_;
};

/// State of the car at the start of a window: x, y [m], psi [rad], vx, vy [m/s], r [rad/s].
using Start = std::array<double, 6>;
/// Predicted sample of a log: x, y of the reference point, psi, speed, r; then three numbers that a log
/// lacks: vx, vy and the road-wheel angle.
using Expected = std::array<double, 8>;

/// Predicts samples first … last - 1 of a log by driving the car from `start` at the time of sample `first`.
void drive(const Car& car, const DriveLog& log, const Actuators& actuators, std::size_t first,
           std::size_t last, const Start& start, std::vector<Expected>& expected);

}  // namespace chicane::identify
