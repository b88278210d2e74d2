// SPDX-License-Identifier: MIT
// The four-wheel plant: its parameters, their conversion from and to a controller's model, and its motion.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>

#include "chicane/base/option.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/model/actuator.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/model/wheel_forces.hpp"
#include "chicane/sim/plant.hpp"

namespace chicane::sim {

/// Parameters of a car with four wheels on a plane. The defaults are those of the plant `road-car`, an
/// ordinary car of 1300 kg and 200 kW on summer tyres; origin of each number: docs/model.md, table 2. Other
/// cars: data/cars/*.yaml.
struct DoubleTrackParams : model::CarBody {
  double load_lag = 0.06;  ///< time constant of the load transfer, as the body rolls and pitches [s]

  double wheel_radius = 0.31;         ///< [m]
  double wheel_inertia = 1.2;         ///< inertia of each of four wheels, with the rotating drive [kg m²]
  double rolling_resistance = 0.013;  ///< torque over load · radius
  double drag = 0.39;                 ///< ½ ρ c_d A [kg/m]
  double downforce_front = 0.0;       ///< ½ ρ c_l A that presses the front axle down [kg/m]
  double downforce_rear = 0.0;        ///< ½ ρ c_l A that presses the rear axle down [kg/m]

  double stiffness_front = 9.0;    ///< magic formula B, front; lower than rear for compliance of the steering
  double stiffness_rear = 10.0;    ///< magic formula B, rear
  double shape = 1.5;              ///< magic formula C
  double relaxation_along = 0.15;  ///< relaxation length of forward slip [m]
  double relaxation_across = 0.30;  ///< relaxation length of lateral slip [m]
  double creep_speed = 3.0;         ///< slip damping fades out up to this speed [m/s]
  double creep_damping = 0.12;      ///< slip per m/s of slip speed, at standstill [s/m]

  double drive_force = 7300.0;   ///< force at full throttle [N]
  double drive_power = 200.0e3;  ///< largest drive force times speed [W]
  double drive_friction = 0.0;   ///< friction of motor and gears, on the driven wheels [N]
  double brake_force = 12350.0;  ///< force at throttle −1 [N]
  double abs_slip_start = 0.10;  ///< forward slip at which anti-lock starts to reduce the brake torque
  double abs_slip_end = 0.18;    ///< forward slip at which anti-lock leaves no brake torque
  double abs_speed = 1.5;        ///< speed below which there is no anti-lock [m/s]
  /// Forward slip at which traction control starts to reduce the drive torque; infinite: no traction control.
  double traction_slip_start = std::numeric_limits<double>::infinity();
  /// Forward slip at which traction control leaves no drive torque.
  double traction_slip_end = std::numeric_limits<double>::infinity();

  static constexpr double kGravity = 9.81;  ///< [m/s²]
  [[nodiscard]] bool has_traction_control() const noexcept {
    return traction_slip_end < std::numeric_limits<double>::infinity();
  }
  /// Force of a tyre over its peak force, by combined slip.
  [[nodiscard]] model::MagicFormula tire(bool is_front) const noexcept {
    return {.stiffness = is_front ? stiffness_front : stiffness_rear, .shape = shape, .peak = 1.0};
  }
  /// Load of one wheel at rest [N].
  [[nodiscard]] double static_load(bool is_front) const noexcept {
    return 0.5 * mass * kGravity * (is_front ? rear_axle : front_axle) / wheelbase();
  }
  /// Causes of changes of the wheels' loads: load moved from the front axle to the rear one and across each
  /// axle [N], and half the square of the speed [m²/s²].
  template <class T>
  struct LoadShift {
    T along, across, pressure;
  };
  /// Load shift at an acceleration of the body (ax, ay) in B [m/s²].
  template <class T>
  [[nodiscard]] LoadShift<T> load_shift(const T& ax, const T& ay, const T& pressure) const {
    return {mass * height * ax / wheelbase(), mass * height * ay / (2.0 * half_track()), pressure};
  }
  /// Load of wheel `i` of wheel_forces() [N] (docs/model.md, eq. 16); negative for a wheel that would lift.
  /// `rest`: its static load [N].
  template <class T>
  [[nodiscard]] T wheel_load(std::size_t i, double rest, const LoadShift<T>& shift) const {
    const double share = i < 2 ? roll_share_front : 1.0 - roll_share_front;
    const T change = (i < 2 ? -0.5 : 0.5) * shift.along + (i % 2 == 0 ? -share : share) * shift.across;
    const double downforce = i < 2 ? downforce_front : downforce_rear;
    if (downforce == 0.0) return rest + change;
    return rest + change + shift.pressure * downforce;
  }
  /// Peak force over load, for a wheel with static load `rest` [N] (eq. 17).
  template <class T>
  [[nodiscard]] T grip(const T& load, double rest) const {
    return friction * (1.0 - load_sensitivity * (load / rest - 1.0));
  }
  /// Actuator of the road-wheel angle.
  [[nodiscard]] model::Actuator steer() const noexcept {
    return {.low = -steer_limit, .high = steer_limit, .lag = steer_lag, .rate = steer_rate_limit};
  }
  /// Actuator of the pedal.
  [[nodiscard]] model::Actuator pedal() const noexcept {
    return {.low = -1.0, .high = 1.0, .lag = drive_lag};
  }

  friend bool operator==(const DoubleTrackParams&, const DoubleTrackParams&) = default;
};

/// The fields with their units and ranges, for files and messages.
[[nodiscard]] std::span<const Option> double_track_options() noexcept;

/// A controller's model of a plant (docs/model.md, eq. 23–27): shared parameters, and derived ones such as
/// accelerations by the inertia with the wheels. `name`, `length` and `width`, which no plant has, stay as in
/// `body`.
[[nodiscard]] model::VehicleParams model_of(const DoubleTrackParams& plant, model::VehicleParams body = {});

/// The plant whose model is `car`: the inverse of model_of(). Parameters that no model has (wheels,
/// relaxation, anti-lock) stay as in `like`. Properties that no plant has, such as drag in proportion to
/// speed, are left out. Pre: `car` is valid and has no steer helper.
[[nodiscard]] DoubleTrackParams plant_of(const model::VehicleParams& car, DoubleTrackParams like = {});

/// The plants `double-track` and `road-car`: planar with quasi-static load transfer and downforce,
/// magic-formula tyres with combined slip and relaxation lengths, proportional brakes with anti-lock, lagging
/// and rate-limited steering, 1 kHz; small cars, whose wheels answer faster, move in several parts of a step.
/// Equations: docs/model.md, eq. 16–22. Valid from standstill (also in reverse rolling) to its top speed; its
/// throttle never reverses.
class DoubleTrack final : public Plant {
 public:
  static constexpr std::string_view kName = "double-track";
  static constexpr std::string_view kMeaning =
      "four wheels that slide and lag; its car file gives the rest; 1 kHz";
  static constexpr std::string_view kRoadCar = "road-car";  ///< name of the plant with default parameters
  static constexpr std::string_view kRoadCarMeaning =
      "an ordinary car: slides, pitches, steers with a lag; 1 kHz";
  static constexpr double kStepLength = 0.001;  ///< [s]

  explicit DoubleTrack(const DoubleTrackParams& params = {}) noexcept;

  [[nodiscard]] double step_length() const noexcept override { return kStepLength; }
  void reset(const model::Pose& pose, double speed) noexcept override;
  void set_motion(const Vec2& velocity, double yaw_rate) noexcept override;
  void deviate(const PlantDeviation& deviation) noexcept override;
  void disturb(const Disturbance& disturbance) noexcept override { disturbance_ = disturbance; }
  void advance(const model::Command& command) noexcept override;
  [[nodiscard]] const model::State& state() const noexcept override { return state_; }
  [[nodiscard]] const PlantOutput& output() const noexcept override { return output_; }
  [[nodiscard]] std::array<Vec2, 4> contact_points() const noexcept override;
  [[nodiscard]] std::unique_ptr<Plant> copy() const override { return std::make_unique<DoubleTrack>(*this); }

 private:
  struct Wheel {
    double static_load = 0.0;  ///< [N]
    double load = 0.0;         ///< [N]
    double speed = 0.0;        ///< [rad/s]
    double slip_along = 0.0;   ///< (ω R − v_x) / |v_x| after relaxation
    double slip_across = 0.0;  ///< −v_y / |v_x| after relaxation
    model::MagicFormula tire;  ///< force over peak force, by combined slip
    double peak_slip = 0.0;    ///< combined slip of the largest force
    double friction = 0.0;     ///< friction torque of the drive train [N m]
    double use = 0.0;          ///< used share of the grip, as PlantOutput::tire_use
  };

  /// Distributes weight, load transfer and downforce to the wheels.
  void load_wheels() noexcept;
  /// Updates the slips of a wheel over a part of a step; its tyre's force [N], in the axes of the wheel like
  /// the velocity `v` of its centre [m/s].
  [[nodiscard]] model::Planar<double> tire_force(Wheel& wheel, const model::Planar<double>& v) const noexcept;
  /// Turns a wheel by its tyre's force [N], drive and brake torque [N m], at a speed along its plane [m/s].
  void spin(Wheel& wheel, double force, double drive, double brake, double speed_along) const noexcept;
  /// Moves wheels and body by a part of a step.
  void move() noexcept;

  DoubleTrackParams nominal_;          ///< parameters before deviate()
  DoubleTrackParams params_;           ///< parameters of this car, which may deviate
  model::Actuator steer_, pedal_way_;  ///< actuators of wheel angle and pedal
  int parts_ = 1;                      ///< parts of a step
  double dt_ = kStepLength;            ///< length of a part [s]
  Disturbance disturbance_;
  std::array<model::Axle, 2> axles_;  ///< front, rear
  std::array<Wheel, 4> wheels_{};     ///< front left, front right, rear left, rear right
  Vec2 velocity_{};                   ///< velocity in W [m/s]
  Vec2 transfer_{};                   ///< lagged acceleration that shifts load, in B [m/s²]
  double pedal_ = 0.0;                ///< pedal after its lag
  model::State state_;
  PlantOutput output_;
};

}  // namespace chicane::sim
