// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "chicane/base/pack.hpp"
#include "chicane/model/prediction.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/model/wheel_forces.hpp"

namespace chicane::safety {

/// A car that is stopped, as far as that does not depend on where it is.
struct StopMotion {
  model::BodyMotion<double> body{};
  /// Acceleration that the wheels' loads have followed, along and across [m/s²].
  double load_along = 0.0;
  double load_across = 0.0;
  /// By which the slip angles of the axles' tyres follow the wheels' [rad].
  double behind_front = 0.0;
  double behind_rear = 0.0;
};

/// The car that a stop is simulated with (docs/guard.md, eq. 3a, 3b). Nobody corrects what it has
/// wrong when the stop is played blindly, so it is closer to a car than PredictionModel: four wheels with
/// their own loads, which follow the body's accelerations with a lag, and the yaw moment of forces that
/// differ from left to right; second order in the step. Slower than kByWheels, and for cars whose tyres do
/// not share force between the directions, it is the PredictionModel. No allocation, no failure for finite
/// input.
class StopCar {
 public:
  /// Speed above which a car has its wheels [m/s]. Chosen: at it the rate of slip of the stiffest tyres, 20
  /// g/v, is 1.2 in a step of 50 ms; the midpoint rule is stable up to 2.
  static constexpr double kByWheels = 8.0;

  explicit StopCar(const model::VehicleParams& vehicle) noexcept : model_{vehicle} { set_vehicle(vehicle); }
  void set_vehicle(const model::VehicleParams& vehicle) noexcept;

  /// What lags leave of a difference.
  struct Left {
    double load, steer, drive;
  };
  /// A step of `dt` [s], and what is the same in all of its length.
  struct Step {
    double dt;
    model::PredictionModel::Lags lags;
    Left middle, end;
  };
  /// 0 < dt <= 0.1.
  [[nodiscard]] Step step(double dt) const noexcept;
  /// The motion after a step towards a road-wheel angle and a net acceleration as asked for. Pre: `step` is
  /// of a car with the same lags.
  [[nodiscard]] StopMotion advance(const StopMotion& from, double steer_command, double acceleration_command,
                                   const Step& step) const noexcept;
  /// Whether it is more than the PredictionModel.
  [[nodiscard]] bool has_wheels() const noexcept { return has_wheels_; }
  [[nodiscard]] const model::VehicleParams& vehicle() const noexcept { return model_.vehicle(); }

 private:
  struct Change {
    double vx, vy, r;      ///< [m/s²], [rad/s²]
    double along, across;  ///< of the body [m/s²]
  };
  [[nodiscard]] Change change(const StopMotion& at) const noexcept;
  /// Slip angles of the axles, front and rear [rad].
  [[nodiscard]] std::array<double, 2> slips(const model::BodyMotion<double>& m) const noexcept;

  using EachWheel = Pack<arch::Baseline, 4>;  ///< front left, front right, rear left, rear right
  /// Constants of the wheels.
  struct Wheels {
    EachWheel x, y;          ///< place, ahead and to the left of the centre of mass [m]
    EachWheel is_front;      ///< 1 or 0
    EachWheel pitches;       ///< 1 where braking unloads the wheel, -1 where it loads it
    EachWheel rolls;         ///< share of the load that leaves the wheel in a bend to the left
    EachWheel rest;          ///< load at rest over the car's mass [m/s²]
    EachWheel down;          ///< twice the share of the load at rest
    EachWheel drive, brake;  ///< shares of an axle's force
    EachWheel cornering;     ///< over friction [1/rad]
  };

  model::PredictionModel model_;
  bool has_wheels_ = false;
  std::array<model::Axle, 2> axles_{};
  Wheels wheels_{};
};

}  // namespace chicane::safety
