// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

#include "chicane/base/vec2.hpp"
#include "chicane/model/actuator.hpp"
#include "chicane/model/tire.hpp"
#include "chicane/sim/plant.hpp"

namespace chicane::sim {

/// An ordinary car of 1300 kg and 200 kW on summer tyres. Origin of each number: docs/plants.md, table 4.
struct RoadCarParams {
  double mass = 1300.0;            ///< [kg]
  double yaw_inertia = 2000.0;     ///< [kg m²]
  double gravity = 9.81;           ///< [m/s²]
  double front_axle = 1.25;        ///< centre of mass to front axle [m]
  double rear_axle = 1.45;         ///< [m]
  double half_track = 0.80;        ///< [m]
  double half_tire = 0.1025;       ///< half the width of a contact patch [m]
  double height = 0.50;            ///< of the centre of mass [m]
  double roll_share_front = 0.58;  ///< of the lateral load transfer, by springs and anti-roll bars
  double load_lag = 0.06;          ///< time constant of the load transfer: the body rolls and pitches [s]

  double wheel_radius = 0.31;         ///< [m]
  double wheel_inertia = 1.2;         ///< [kg m²]
  double rolling_resistance = 0.013;  ///< torque over load · radius
  double drag = 0.39;                 ///< ½ ρ c_d A [kg/m]

  double friction = 1.20;          ///< peak force over load at the static load of a wheel
  double load_sensitivity = 0.08;  ///< friction lost per static load of a wheel added
  double stiffness_front = 9.0;    ///< magic formula B of slip; front less for compliance of the steering
  double stiffness_rear = 10.0;
  double shape = 1.5;               ///< magic formula C
  double curvature = 0.0;           ///< magic formula E
  double relaxation_along = 0.15;   ///< relaxation length of forward slip [m]
  double relaxation_across = 0.30;  ///< of lateral slip [m]
  double creep_speed = 3.0;         ///< slip damping fades out up to this speed [m/s]
  double creep_damping = 0.12;      ///< slip per m/s of slip speed, at standstill [s/m]

  double drive_force = 7300.0;      ///< at full throttle [N]
  double drive_power = 200.0e3;     ///< [W]
  double drive_share_front = 0.40;  ///< all-wheel drive, open differentials
  double brake_force = 12350.0;     ///< at throttle −1 [N]
  double brake_share_front =
      0.72;                      ///< bias; the front locks first up to 0.9 g, as UN R13-H asks of road cars
  double abs_slip_start = 0.10;  ///< anti-lock: brake torque falls from here ...
  double abs_slip_end = 0.18;    ///< ... to nothing here
  double abs_speed = 1.5;        ///< no anti-lock below [m/s]

  model::Actuator steer{.low = -0.4363323129985824,
                        .high = 0.4363323129985824,
                        .lag = 0.05,
                        .rate = 1.5707963267948966};  ///< ±25°, 90°/s
  model::Actuator pedal{.low = -1.0, .high = 1.0, .lag = 0.1};
};

/// The plant `road-car`: double track, planar with quasi-static load transfer, magic-formula tyres with
/// combined slip and relaxation lengths, proportional brakes with anti-lock, lagging and rate-limited
/// steering, 1 kHz. Equations: docs/plants.md, eq. 2–8. Valid from standstill (also in reverse rolling) to
/// its top speed; its throttle never reverses.
class RoadCar final : public Plant {
 public:
  static constexpr std::string_view kName = "road-car";
  static constexpr std::string_view kMeaning = "an ordinary car: slides, pitches, steers with a lag; 1 kHz";
  static constexpr double kStepLength = 0.001;  ///< [s]

  explicit RoadCar(const RoadCarParams& params = {}) noexcept;

  [[nodiscard]] double step_length() const noexcept override { return kStepLength; }
  void reset(const model::Pose& pose, double speed) noexcept override;
  void set_motion(const Vec2& velocity, double yaw_rate) noexcept override;
  void deviate(const PlantDeviation& deviation) noexcept override;
  void disturb(const Disturbance& disturbance) noexcept override { disturbance_ = disturbance; }
  void advance(const model::Command& command) noexcept override;
  [[nodiscard]] const model::State& state() const noexcept override { return state_; }
  [[nodiscard]] const PlantOutput& output() const noexcept override { return output_; }
  [[nodiscard]] std::array<Vec2, 4> contact_points() const noexcept override;

 private:
  struct Wheel {
    Vec2 position{};           ///< in B [m]
    double static_load = 0.0;  ///< [N]
    double load = 0.0;         ///< [N]
    double speed = 0.0;        ///< [rad/s]
    double slip_along = 0.0;   ///< relaxed (ω R − v_x) / |v_x|
    double slip_across = 0.0;  ///< relaxed −v_y / |v_x|
    model::MagicFormula tire;
    double peak_slip = 0.0;  ///< combined slip of the largest force
    double use = 0.0;        ///< of the grip, as PlantOutput::tire_use
  };

  [[nodiscard]] double static_load(bool is_front) const noexcept;  ///< of one wheel [N]
  void load_wheels() noexcept;
  [[nodiscard]] Vec2 tire_force(Wheel& wheel, const Vec2& v) const noexcept;
  void spin(Wheel& wheel, double force, double drive, double brake, double speed_along) const noexcept;
  void move() noexcept;

  RoadCarParams nominal_;
  RoadCarParams params_;  ///< those of this car, which may deviate
  Disturbance disturbance_;
  std::array<Wheel, 4> wheels_{};
  Vec2 velocity_{};     ///< in W [m/s]
  Vec2 transfer_{};     ///< lagged acceleration that shifts load, in B [m/s²]
  double pedal_ = 0.0;  ///< after its lag
  model::State state_;
  PlantOutput output_;
};

}  // namespace chicane::sim
