// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "chicane/base/math.hpp"
#include "chicane/lap_time/detail/plan_model.hpp"
#include "chicane/model/actuator.hpp"
#include "chicane/model/prediction.hpp"
#include "chicane/model/stability.hpp"
#include "chicane/model/wheel_forces.hpp"
#include "chicane/sim/double_track.hpp"
#include "chicane/sim/udacity_car.hpp"

/// Equations of three cars for the search of a fastest lap: the plants `udacity` and `double-track`, and the
/// model of controllers. functions() of each writes, for the variables z of node k, the rates of the states
/// by arc length, the equations (= 0), the cost and the inequalities (>= 0), as NodeFunctions orders them.

namespace chicane::lap_time {

/// The plant `udacity` (sim/udacity_car.hpp) in continuous time, its wheels in balance (docs/limit.md,
/// section 1). Variables: offset, heading, vx, vy, yaw rate, steering angle, longitudinal tyre force over
/// mass; rates of the last two.
struct UdacityModel {
  static constexpr int kVariables = 9;
  static constexpr int kStates = 7;
  static constexpr int kEquations = 0;
  static constexpr int kInequalities = 12;
  /// Feedback along a plan: number of its states, then the variable of its first input.
  static constexpr int kDriven = 5, kInput = 5;
  static constexpr std::array<double, kVariables> scale() {
    return {2.0, 0.2, 20.0, 2.0, 1.0, 0.1, 5.0, 1.0, 50.0};
  }

  sim::UdacityCarParams car{};
  const RoadNodes* road = nullptr;
  double margin = 0.0;                              ///< distance kept from the edges [m]
  double slip_share = kNoCap;                       ///< largest front slip over the slip of peak force
  static constexpr double kNoCap = 10.0;            ///< slip share that no lap reaches; chosen
  double brake_share = 1.0;                         ///< share of the force at which the rear wheels lock
  double steer_weight = 1e-5, pedal_weight = 1e-5;  ///< weights of squared rates in the cost; chosen

  /// Mean delay of the helper at the tyres, over the parts of a step [s].
  static constexpr double kHelperLag = 0.375 * sim::UdacityCar::kStepLength;

  /// Time derivatives of velocity [m/s²] and yaw rate [rad/s²].
  template <class T>
  struct Motion {
    T vx, vy, yaw;
  };

  /// Load of all tyres over mass [m/s²].
  template <class T>
  [[nodiscard]] T load(const T& speed) const {
    const double rest = (car.mass + 4.0 * car.wheel_mass) * car.gravity;
    const double slope = (3.0 - car.load_filter_offset) / 3.0;
    const double per_mass = car.friction_scale / car.mass;
    return per_mass * (rest * (car.load_filter_offset + slope) + slope * car.downforce * speed);
  }
  /// Share of the load on the rear wheels.
  [[nodiscard]] double rear_share() const { return car.front_axle / (car.front_axle + car.rear_axle); }
  /// Share of the longitudinal force that the front wheels give: all wheels have the same torque.
  [[nodiscard]] double front_pull() const {
    return (1.0 / car.front_radius) / (1.0 / car.front_radius + 1.0 / car.rear_radius);
  }

  /// Motion under a longitudinal tyre force `pull` over mass; `left_out`: missing share of the steer helper.
  template <class T>
  [[nodiscard]] Motion<T> motion(const T& vx, const T& vy, const T& r, const T& steer, const T& pull,
                                 const T& left_out = T(0.0)) const {
    const T cs = cos(steer);
    const T sn = sin(steer);
    const T all = load(T(sqrt(vx * vx + vy * vy)));
    const double wheelbase = car.front_axle + car.rear_axle;
    const T front_load = (0.5 * car.rear_axle / wheelbase) * all;
    const T rear_load = (0.5 * car.front_axle / wheelbase) * all;
    const T front_pull_each = (0.5 * front_pull()) * pull;
    const T rear_pull_each = (0.5 - 0.5 * front_pull()) * pull;
    T fx(0.0);
    T fy(0.0);
    T moment(0.0);
    const T vy_front = vy + car.front_axle * r;
    const T vy_rear = vy - car.rear_axle * r;
    for (const double y : {car.half_track, -car.half_track}) {
      const T vx_here = vx - y * r;
      const T along = cs * vx_here + sn * vy_front;
      const T across = cs * vy_front - sn * vx_here;
      const T side = -front_load * car.sideways(T(atan(across / (along + car.lateral_speed_offset))));
      const T x = cs * front_pull_each - sn * side;
      const T z = sn * front_pull_each + cs * side;
      const T rear_side = -rear_load * car.sideways(T(atan(vy_rear / (vx_here + car.lateral_speed_offset))));
      fx += x + rear_pull_each;
      fy += z + rear_side;
      moment += car.front_axle * z - car.rear_axle * rear_side - y * (x + rear_pull_each);
    }
    // The explicit parts of the plant's step add energy: half the squared change of velocity in a part.
    const T gain = (0.5 * sim::UdacityCar::kStepLength / sim::UdacityCar::kParts) * (fx * fx + fy * fy) /
                   (vx * vx + vy * vy);
    const T stay = 1.0 - car.steer_helper * (1.0 - left_out);
    const T turn = (car.mass / car.yaw_inertia) * moment - car.angular_drag * r;
    // The helper acts a part of a step late: the velocity lags behind a body that begins to turn.
    const T behind = (kHelperLag * car.steer_helper) * turn;
    return {fx + stay * r * vy + (gain - car.linear_drag) * vx + behind * vy,
            fy - stay * r * vx + (gain - car.linear_drag) * vy - behind * vx, turn};
  }

  template <class T>
  void functions(std::size_t k, const T* z, T* out) const {
    const RoadNodes& at = *road;
    const T& n = z[kOffset];
    const T& r = z[kYawRate];
    const T& pull = z[kPedal];
    const OnRoad<T> on(at.curvature[k], n, z[kHeading], z[kVx], z[kVy]);
    const T left_out = model::helper_left_out(sim::UdacityCar::kStepLength, at.heading[k], z[kHeading], r);
    const Motion<T> m = motion(z[kVx], z[kVy], r, z[kSteer], pull, left_out);
    *out++ = (on.s * z[kVx] + on.c * z[kVy]) * on.slowness;
    *out++ = r * on.slowness;  // Collocation adds the turn of the line
    *out++ = m.vx * on.slowness;
    *out++ = m.vy * on.slowness;
    *out++ = m.yaw * on.slowness;
    *out++ = z[7] * on.slowness;
    *out++ = z[8] * on.slowness;
    *out++ = (1.0 + steer_weight * (z[7] * z[7]) + (1e-4 * pedal_weight) * (z[8] * z[8])) * on.slowness;
    out = on.edge_gaps(at, k, n, size(), margin, out);
    *out++ = (1.0 / car.steer_limit) * z[kSteer] + 1.0;
    *out++ = 1.0 - (1.0 / car.steer_limit) * z[kSteer];
    *out++ = 0.2 * (drive() - damping() * z[kVx] - pull - turning_mass() * m.vx);
    *out++ = 0.1 * pull + (0.1 * brake_share * rear_share() / (1.0 - front_pull())) * load(z[kVx]);
    const T slip = (1.0 / (slip_share * car.sideways.extremum_slip)) *
                   (atan((z[kVy] + car.front_axle * r) / (z[kVx] + car.lateral_speed_offset)) - z[kSteer]);
    *out++ = 1.0 - slip;
    *out++ = 1.0 + slip;
    *out++ = 0.1 * (z[kVx] - 2.5);
    *out++ = 0.1 * (car.speed_cap - z[kVx]);
  }

  [[nodiscard]] CarSize size() const {
    return {car.front_axle, car.rear_axle, car.half_track + car.half_tire, car.steer_limit};
  }
  /// Acceleration by the wheels' torques at full pedal, less the part lost to slip [m/s²] (docs/limit.md,
  /// eq. 3).
  [[nodiscard]] double drive() const {
    constexpr double kSlipLoss = 0.0055;  // measured: 5.43 m/s² at rest, by mean speeds
    const double per_radius = 1.0 / car.front_radius + 1.0 / car.rear_radius;
    return (1.0 - kSlipLoss) * 0.5 * car.drive_torque * per_radius / car.mass;
  }
  /// Deceleration by the wheels' damping over speed [1/s].
  [[nodiscard]] double damping() const {
    constexpr double kRimsFaster = 1.05;  // rim speed over road speed, in the mean; measured
    return kRimsFaster * 2.0 * car.wheel_damping *
           (1.0 / (car.front_radius * car.front_radius) + 1.0 / (car.rear_radius * car.rear_radius)) /
           car.mass;
  }
  /// Equivalent mass of the turning wheels over mass of the body.
  [[nodiscard]] double turning_mass() const { return 2.0 * car.wheel_mass / car.mass; }
  /// Pedal for a longitudinal tyre force `pull` over mass while vx changes by `change` [m/s²].
  [[nodiscard]] double pedal_for(double pull, double vx, double change) const {
    const double torque = pull + damping() * vx + turning_mass() * change;
    return torque >= 0.0 ? torque / drive() : torque / (4.0 * car.brake_torque / car.drive_torque * drive());
  }
};

/// The plants `double-track` and `road-car` (sim/double_track.hpp), with tyres in steady slip and wheels in
/// balance (docs/limit.md, section 1). Variables: offset, heading, vx, vy, yaw rate, steering angle, pedal
/// after its lag, the lagged accelerations that shift load; rates of steering and pedal; the forward slip of
/// each wheel, which follows from the balance of its torques.
struct DoubleTrackModel {
  static constexpr int kVariables = 15;
  static constexpr int kStates = 9;
  static constexpr int kEquations = 4;
  static constexpr int kInequalities = 17;
  static constexpr int kShiftX = 7, kShiftY = 8, kSteerRate = 9, kPedalRate = 10, kSlip = 11;
  /// Feedback along a plan: number of its states, then the variable of its first input.
  static constexpr int kDriven = 9, kInput = 9;
  static constexpr std::array<double, kVariables> scale() {
    return {2.0, 0.2, 20.0, 2.0, 1.0, 0.1, 1.0, 10.0, 10.0, 1.0, 10.0, 0.1, 0.1, 0.1, 0.1};
  }

  sim::DoubleTrackParams car{};
  const RoadNodes* road = nullptr;
  double margin = 0.0;                              ///< distance kept from the edges [m]
  double grip_share = 1.0;                          ///< used share of the tyres' force
  double slip_share = kNoCap;                       ///< largest combined slip over the slip of peak force
  double steer_weight = 1e-5, pedal_weight = 1e-5;  ///< weights of squared rates in the cost; chosen

  template <class T>
  struct Motion {
    T ax, ay, yaw;             ///< acceleration in the body's axes [m/s²], yaw acceleration [rad/s²]
    std::array<T, 4> balance;  ///< sum of torques of each wheel over rest load and radius
    std::array<T, 4> slip;     ///< squared combined slip of each wheel
  };

  /// Motion by the variables of a node.
  template <class T>
  [[nodiscard]] Motion<T> motion(const T* z) const {
    const T& vx = z[kVx];
    const T& vy = z[kVy];
    const T& r = z[kYawRate];
    const T cosine = cos(z[kSteer]);
    const T sine = sin(z[kSteer]);
    const T square = vx * vx + vy * vy;
    // Downforce is left out: plans that rely on it leave the road when they are driven.
    const auto shift = car.load_shift(z[kShiftX], z[kShiftY], T(0.0));
    const T drive = (0.5 * car.drive_force) * Corners::positive(z[kPedal], kPedalCorner);
    const T brake = (0.5 * car.brake_force) * Corners::positive(T(-z[kPedal]), kPedalCorner);
    const T spin = (car.wheel_inertia / (car.wheel_radius * car.wheel_radius)) * (z[kShiftX] + r * vy);
    const T air = -car.drag * sqrt(square);
    Motion<T> m;
    const auto force_of = [&](std::size_t i, const model::Axle& axle, const model::Planar<T>& v) {
      const double rest = car.static_load(i < 2);
      const T load = Corners::positive(car.wheel_load(i, rest, shift), kLoadCorner);
      const model::Planar<T> rolling = i < 2 ? model::in_turned_axes(v, cosine, sine) : v;
      const T& slip = z[kSlip + i];
      const T side = -rolling.y / rolling.x;
      m.slip[i] = slip * slip + side * side;
      const T size = sqrt(m.slip[i] + kLeastSlip * kLeastSlip);
      const T force = grip_share * (load * car.grip(load, rest)) * car.tire(i < 2)(size) / size;
      const model::Planar<T> tire{force * slip, force * side};
      m.balance[i] =
          (1.0 / rest) * (tire.x - axle.drive_share * driven(drive, slip) +
                          axle.brake_share * brake *
                              model::torque_share<Corners>(T(-slip), car.abs_slip_start, car.abs_slip_end) +
                          car.rolling_resistance * load + 0.5 * axle.drive_share * car.drive_friction + spin);
      return tire;
    };
    const auto sum = model::wheel_forces<T>(car.axles(), {vx, vy}, r, cosine, sine,
                                            {air * vx, air * vy, T(0.0)}, force_of);
    m.ax = (1.0 / car.mass) * sum.x;
    m.ay = (1.0 / car.mass) * sum.y;
    m.yaw = (1.0 / car.yaw_inertia) * sum.moment;
    return m;
  }

  /// Drive force that traction control permits at a slip.
  template <class T>
  [[nodiscard]] T driven(const T& drive, const T& slip) const {
    if (!car.has_traction_control()) return drive;
    return drive * model::torque_share<Corners>(slip, car.traction_slip_start, car.traction_slip_end);
  }

  template <class T>
  void functions(std::size_t k, const T* z, T* out) const {
    const RoadNodes& at = *road;
    const T& n = z[kOffset];
    const T& r = z[kYawRate];
    const T& steer = z[kSteer];
    const T& pedal = z[kPedal];
    const OnRoad<T> on(at.curvature[k], n, z[kHeading], z[kVx], z[kVy]);
    const Motion<T> m = motion(z);
    *out++ = (on.s * z[kVx] + on.c * z[kVy]) * on.slowness;
    *out++ = r * on.slowness;  // Collocation adds the turn of the line
    *out++ = (m.ax + r * z[kVy]) * on.slowness;
    *out++ = (m.ay - r * z[kVx]) * on.slowness;
    *out++ = m.yaw * on.slowness;
    *out++ = z[kSteerRate] * on.slowness;
    *out++ = z[kPedalRate] * on.slowness;
    *out++ = (1.0 / car.load_lag) * (m.ax - z[kShiftX]) * on.slowness;
    *out++ = (1.0 / car.load_lag) * (m.ay - z[kShiftY]) * on.slowness;
    for (const T& b : m.balance) *out++ = b;
    *out++ = (1.0 + steer_weight * (z[kSteerRate] * z[kSteerRate]) +
              (0.01 * pedal_weight) * (z[kPedalRate] * z[kPedalRate])) *
             on.slowness;
    out = on.edge_gaps(at, k, n, size(), margin, out);
    const T steer_command = (1.0 / car.steer_limit) * (steer + car.steer_lag * z[kSteerRate]);
    *out++ = 1.0 - steer_command;
    *out++ = 1.0 + steer_command;
    *out++ = 1.0 - (1.0 / car.steer_rate_limit) * z[kSteerRate];
    *out++ = 1.0 + (1.0 / car.steer_rate_limit) * z[kSteerRate];
    const T pedal_command = pedal + car.drive_lag * z[kPedalRate];
    *out++ = 1.0 - pedal_command;
    *out++ = 1.0 + pedal_command;
    *out++ = 1.0 - (car.drive_force / car.drive_power) * (pedal * z[kVx]);
    *out++ = 0.1 * (z[kVx] - 2.5);
    *out++ = 1.0 - (1.0 / 100.0) * z[kVx];
    for (std::size_t i = 0; i < 4; ++i) {
      const double most = slip_share * car.tire(i < 2).peak_slip();
      *out++ = 1.0 - (1.0 / (most * most)) * m.slip[i];
    }
  }

  [[nodiscard]] CarSize size() const {
    return {car.front_axle, car.rear_axle, car.half_track() + car.half_tire(), car.steer_limit};
  }

  static constexpr double kNoCap = 10.0;  ///< slip share that no lap reaches; chosen

 private:
  using Corners = model::Rounded;
  // Widths of rounded corners; chosen.
  static constexpr double kPedalCorner = 0.01;  ///< rounding of the pedal at 0
  static constexpr double kLoadCorner = 50.0;   ///< rounding of a wheel's load at 0 [N]
  static constexpr double kLeastSlip = 1e-3;    ///< rounding of the slip's size at 0
};

/// The car as a controller models it (model/prediction.hpp), in continuous time (docs/racing.md, section 1).
/// Variables: offset, heading, vx, vy, yaw rate, steering angle, net acceleration; rates of the last two.
struct VehicleModel {
  static constexpr int kVariables = 9;
  static constexpr int kStates = 7;
  static constexpr int kEquations = 0;
  static constexpr int kInequalities = 18;
  static constexpr std::array<double, kVariables> scale() {
    return {2.0, 0.2, 20.0, 2.0, 1.0, 0.1, 5.0, 1.0, 50.0};
  }

  model::PredictionModel model{model::VehicleParams{}};
  model::BrakingStability stability{model::VehicleParams{}};  ///< braking bound with all of the grip
  bool is_steered_slowly = false;                             ///< slow steering: the plan respects its rate
  model::SlidingBound sliding{model::VehicleParams{}};        ///< bound on slip beyond the peak
  bool slides = false;                                        ///< slips may reach `sliding`
  const RoadNodes* road = nullptr;
  double margin = 0.0;         ///< distance kept from the edges [m]
  double slip_share = 1.0;     ///< largest slip of an axle over its peak slip
  double brake_share = 1.0;    ///< used share of the largest useful deceleration
  double speed_limit = 100.0;  ///< largest speed [m/s]
  double steer_weight = 1e-3;  ///< weight of the steering's rate squared, in time [s/rad²·s]
  double jerk_weight = 1e-6;   ///< weight of the squared jerk in the cost; chosen

  [[nodiscard]] CarSize size() const {
    const model::VehicleParams& car = model.vehicle();
    return {car.front_axle, car.rear_axle, 0.5 * (car.track_width + car.tire_width), car.steer_limit};
  }
  /// Deceleration by drag [m/s²].
  template <class T>
  [[nodiscard]] T drag(const T& v) const {
    const model::VehicleParams& car = model.vehicle();
    return car.drag_constant + car.drag_linear * v + car.drag_quadratic * (v * v);
  }

  template <class T>
  void functions(std::size_t k, const T* z, T* out) const {
    const RoadNodes& at = *road;
    const model::VehicleParams& car = model.vehicle();
    const T& n = z[kOffset];
    const T& vx = z[kVx];
    const T& steer = z[kSteer];
    const T& net = z[kPedal];
    const T& steer_rate = z[7];
    const T& jerk = z[8];
    const OnRoad<T> on(at.curvature[k], n, z[kHeading], vx, z[kVy]);
    const model::BodyMotion<T> body{vx, z[kVy], z[kYawRate], steer, net};
    auto change = model.change(body);
    if (slides && car.helper_gap > 0.0) {
      const T left_out = model::helper_left_out(car.helper_gap, at.heading[k], z[kHeading], z[kYawRate]);
      const T turn = car.steer_helper * left_out * z[kYawRate];
      change.vx = change.vx + turn * z[kVy];
      change.vy = change.vy - turn * vx;
    }
    *out++ = (on.s * vx + on.c * z[kVy]) * on.slowness;
    *out++ = z[kYawRate] * on.slowness;  // Collocation adds the turn of the line
    *out++ = change.vx * on.slowness;
    *out++ = change.vy * on.slowness;
    *out++ = change.r * on.slowness;
    *out++ = steer_rate * on.slowness;
    *out++ = jerk * on.slowness;
    *out++ = (1.0 + steer_weight * (steer_rate * steer_rate) + jerk_weight * (jerk * jerk)) * on.slowness;
    out = on.edge_gaps(at, k, n, size(), margin, out);
    const T asked = (1.0 / car.steer_limit) * (steer + car.steer_lag * steer_rate);
    *out++ = 1.0 + asked;
    *out++ = 1.0 - asked;
    const double rate = std::min(car.steer_rate_limit, kMostSteerRate);
    *out++ = 1.0 + (1.0 / rate) * steer_rate;
    *out++ = 1.0 - (1.0 / rate) * steer_rate;
    const T force = net + car.drive_lag * jerk + drag(vx);
    *out++ = 0.2 * (car.drive_acceleration - force);
    *out++ = 0.2 * (std::min(car.drive_power_per_mass, kMostPower) / vx - force);
    *out++ = 0.1 * (force + brake_share * car.brake_throttle_limit * car.brake_acceleration);
    const T slip = slip_share * (1.0 - kSlipPerSpeed * vx);
    const T share = slides ? model::SlidingBound::share(vx) : T(0.0);
    const T front = slip + share * (slip_share * sliding.front() - slip);
    const T rear = slip + share * (slip_share * sliding.rear(vx) - slip);
    *out++ = front * front - change.square_front;
    *out++ = rear * rear - change.square_rear;
    *out++ = kMostAlong - change.along_front;
    *out++ = kMostAlong - change.along_rear;
    *out++ = stable_braking(T(net + drag(vx)), vx, z[kYawRate]);
    *out++ = 0.1 * (vx - kLeastSpeed);
    *out++ = 0.1 * (speed_limit - vx);
  }

  /// Distance of a braking force over mass from the bound of BrakingStability; negative beyond it.
  template <class T>
  [[nodiscard]] T stable_braking(const T& force, const T& vx, const T& yaw_rate) const {
    if (!is_steered_slowly) return T(1.0);
    const T lateral = (1.0 - model.vehicle().steer_helper) * vx * yaw_rate;
    const T use = stability.use(T(sqrt(lateral * lateral + kLeastLateral * kLeastLateral)), vx);
    return 0.1 * (force + stability.smooth_most_braking(vx, use));
  }

  // Chosen.
  static constexpr double kLeastLateral = 0.1;    ///< rounding of |lateral acceleration| [m/s²]
  static constexpr double kMostSteerRate = 10.0;  ///< steering rate that stands for an instant change [rad/s]
  static constexpr double kMostPower = 1e4;       ///< power over mass that stands for no limit [W/kg]
  static constexpr double kMostAlong = 0.95;      ///< used share of a tyre's force: the rest holds the course
  static constexpr double kLeastSpeed = 2.5;      ///< least speed of a plan [m/s]
  /// Decrease of slip_share with speed [s/m]: at speed yaw is damped less, and the car covers more road
  /// before a command acts. Three quarters are left at 50 m/s.
  static constexpr double kSlipPerSpeed = 0.005;
};

}  // namespace chicane::lap_time
