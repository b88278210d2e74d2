// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "chicane/identify/drive_log.hpp"
#include "chicane/identify/identification.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/model/wheel_forces.hpp"

namespace chicane::identify {

/// Four-wheel car for the fit (docs/identification.md, eq. 3, 4): the forces of the controllers' model, and
/// effects that a log near the limit shows beyond it. Tyres build up force over a distance, load moves with a
/// lag, angles are not small. Plain arithmetic, no allocation.
///
/// Pre: a tyre of the magic formula, no steering helper (has_four_wheels()).
class FourWheels {
 public:
  /// Motion of the car at a moment. Slips and transfer are half a step older.
  struct Motion {
    double vx = 0.0, vy = 0.0;             ///< velocity of the centre of mass in the car's axes [m/s]
    double r = 0.0;                        ///< [rad/s]
    std::array<double, 4> slip{};          ///< across: front left, front right, rear left, rear right
    std::array<double, 4> slip_along{};    ///< forward; of the last step
    std::array<double, 4> rolling{};       ///< speeds of the wheels' centres a step ago [m/s]
    double along = 0.0, across = 0.0;      ///< lagged accelerations that shift load [m/s²]
    double resistance = 0.0;               ///< deceleration by turned front wheels in the last step [m/s²]
    double forward = 0.0, sideways = 0.0;  ///< acceleration by all forces in the last step [m/s²]
  };

  FourWheels(const model::VehicleParams& vehicle, const Wheels& wheels, double dt) noexcept;

  /// The motion of a car that has driven like that for a while, with `acceleration` along it.
  [[nodiscard]] Motion steady(double vx, double vy, double r, double steer,
                              double acceleration) const noexcept;
  /// One step of dt. `steer` is the road-wheel angle at its start, `steer_middle` in its middle; `force` the
  /// demand of drive and brakes on all wheels over mass, `drag` the other resistances [m/s²].
  void advance(Motion& motion, double steer, double steer_middle, double force, double drag) const noexcept;

 private:
  struct Tire {
    double cornering;   ///< stiffness over friction
    double per_along;   ///< share of a wheel's rest load for each m/s² along
    double per_across;  ///< share of a wheel's rest load for each m/s² across
  };

  model::VehicleParams vehicle_;
  double dt_;
  double per_relaxation_;  ///< [1/m]
  double load_share_;      ///< share of the lag of load that one step covers
  Wheels wheels_;
  double rotating_;
  double inertia_;  ///< wheel inertia over (squared radius · mass of the car)
  double turn_;     ///< mass over yaw inertia [1/m²]
  std::array<model::Axle, 2> axles_;
  std::array<Tire, 2> tires_{};  ///< tyres of front and rear axle
};

/// Whether FourWheels can represent a car.
[[nodiscard]] inline bool has_four_wheels(const model::VehicleParams& vehicle) noexcept {
  return vehicle.steer_helper == 0.0 && vehicle.tire_shape > 1.0 && vehicle.friction_coupling > 0.0;
}

/// Car of the fit: the controllers' model, and the delays and lags between a command and the car.
struct Car {
  model::VehicleParams vehicle;
  double delay = 0.1;         ///< time from command to effect [s]
  double steer_offset = 0.0;  ///< road-wheel angle beyond the commanded one [rad]
  double reference = 0.0;     ///< the log's reference point ahead of the centre of mass [m]
  Wheels wheels{};            ///< used where has_four_wheels()
};

/// Steering and drive of a log, on a grid: they need the commands and measured speeds alone.
class Actuators {
 public:
  static constexpr double kStep = 0.01;  ///< step of the grid [s]

  Actuators(const DriveLog& log, const Car& car);
  [[nodiscard]] double start() const noexcept { return start_; }
  [[nodiscard]] std::size_t size() const noexcept { return steer_.size(); }
  /// Inputs at grid point `i`, and means of the demand over the step from there.
  [[nodiscard]] double steer(std::size_t i) const noexcept { return steer_[i]; }
  [[nodiscard]] double steer_mean(std::size_t i) const noexcept { return steer_mean_[i]; }
  [[nodiscard]] double acceleration(std::size_t i) const noexcept { return acceleration_[i]; }
  [[nodiscard]] double throttle(std::size_t i) const noexcept { return throttle_[i]; }
  [[nodiscard]] double pedal(std::size_t i) const noexcept { return pedal_[i]; }  ///< pedal after its lag
  [[nodiscard]] double speed(std::size_t i) const noexcept { return speed_[i]; }  ///< measured speed

 private:
  double start_;
  std::vector<double> steer_, steer_mean_, acceleration_, throttle_, pedal_, speed_;
};

/// State at the start of a window: x, y [m], psi [rad], vx, vy [m/s], r [rad/s].
using Start = std::array<double, 6>;
/// Predicted sample of a log: x, y of the reference point, psi, speed, r; then three that a log lacks: vx, vy
/// and the road-wheel angle.
using Expected = std::array<double, 8>;

/// Drives the car from `start` at the time of sample `first`: what samples first … last - 1 would be.
void drive(const Car& car, const DriveLog& log, const Actuators& actuators, std::size_t first,
           std::size_t last, const Start& start, std::vector<Expected>& expected);

}  // namespace chicane::identify
