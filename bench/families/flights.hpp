// SPDX-License-Identifier: MIT
#pragma once

#include "families/family.hpp"

namespace chicane::bench {

/// A planar quadrotor flies past a round obstacle that stands about in its way. States: position [m], pitch
/// [rad], and their rates; inputs: the two rotors' thrusts [N].
struct PlanarQuadrotor : FamilyProblem<6, 2> {
  static constexpr std::string_view kName = "planar quadrotor past an obstacle";
  static constexpr int kNr = 8, kNe = 6, kNc = 2, kHorizon = 50;
  static constexpr double kStep = 0.05, kGravity = 9.81, kArm = 0.2;
  double mass = 1.0, inertia = 0.02, strongest = 10.0;
  double obstacle_x = 2.0, obstacle_z = 0.5, radius = 0.6;

  CHICANE_INLINE auto dynamics(auto, const auto& x, const auto& u) const {
    const auto& [px, pz, pitch, vx, vz, rate] = x;
    const auto& [left, right] = u;
    const auto lift = (left + right) * (1.0 / mass);
    const auto wx = vx + kStep * (lift * sin(pitch));
    const auto wz = vz + kStep * (lift * cos(pitch) - kGravity);
    const auto w = rate + (kStep * kArm / inertia) * (left - right);
    return std::make_tuple(px + kStep * wx, pz + kStep * wz, pitch + kStep * w, wx, wz, w);
  }
  CHICANE_INLINE auto residual(auto, const auto& x, const auto& u) const {
    const auto& [px, pz, pitch, vx, vz, rate] = x;
    const auto& [left, right] = u;
    const double hover = 0.5 * mass * kGravity;
    return std::make_tuple(0.3 * (px - goal[0]), 0.3 * (pz - goal[1]), 0.1 * pitch, 0.1 * vx, 0.1 * vz,
                           0.1 * rate, 0.1 * (left - hover), 0.1 * (right - hover));
  }
  CHICANE_INLINE auto terminal_residual(const auto& x) const {
    const auto& [px, pz, pitch, vx, vz, rate] = x;
    return std::make_tuple(10.0 * (px - goal[0]), 10.0 * (pz - goal[1]), 5.0 * pitch, 5.0 * vx, 5.0 * vz,
                           2.0 * rate);
  }
  CHICANE_INLINE auto constraint(auto, const auto& x,
                                 const auto&) const {  // outside the obstacle, above the ground
    const auto dx = std::get<0>(x) - obstacle_x;
    const auto dz = std::get<1>(x) - obstacle_z;
    return std::make_tuple(radius * radius - dx * dx - dz * dz, -1.0 - std::get<1>(x));
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 200.0, .quadratic = 100.0}; }
  [[nodiscard]] std::array<double, 2> input_lower(int) const { return {0.0, 0.0}; }
  [[nodiscard]] std::array<double, 2> input_upper(int) const { return {strongest, strongest}; }

  void draw(Random& random) {
    mass = random.uniform(0.7, 1.2);
    inertia = random.uniform(0.01, 0.03);
    goal = {random.uniform(3.0, 5.0), random.uniform(-0.5, 1.5)};
    obstacle_x = goal[0] * random.uniform(0.35, 0.65);
    obstacle_z = 0.5 * goal[1] + random.uniform(-0.4, 0.4);
    radius = random.uniform(0.3, 0.8);
    start = {0.0, 0.0, random.uniform(-0.3, 0.3), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 0.0};
    idle = {0.5 * mass * kGravity, 0.5 * mass * kGravity};
  }
};

/// A quadrotor with attitude control inside flies in space past two balls. States: position [m], velocity
/// [m/s], roll, pitch and yaw [rad]; inputs: thrust over mass [m/s²] and the rates of the three angles
/// [rad/s].
struct Quadrotor : FamilyProblem<9, 4> {
  static constexpr std::string_view kName = "quadrotor past two balls";
  static constexpr int kNr = 13, kNe = 9, kNc = 2, kHorizon = 40;
  static constexpr double kStep = 0.06, kGravity = 9.81;
  std::array<double, 3> ball_1{1.5, 0.1, 0.3}, ball_2{3.0, -0.2, 0.8};
  double radius_1 = 0.6, radius_2 = 0.5;

  CHICANE_INLINE auto dynamics(auto, const auto& x, const auto& u) const {
    const auto& [px, py, pz, vx, vy, vz, roll, pitch, yaw] = x;
    const auto& [thrust, p, q, r] = u;
    const auto sr = sin(roll), cr = cos(roll), sp = sin(pitch), cp = cos(pitch), sy = sin(yaw), cy = cos(yaw);
    const auto wx = vx + kStep * (thrust * (cy * sp * cr + sy * sr) - 0.1 * vx);
    const auto wy = vy + kStep * (thrust * (sy * sp * cr - cy * sr) - 0.1 * vy);
    const auto wz = vz + kStep * (thrust * (cp * cr) - kGravity - 0.1 * vz);
    return std::make_tuple(px + kStep * wx, py + kStep * wy, pz + kStep * wz, wx, wy, wz, roll + kStep * p,
                           pitch + kStep * q, yaw + kStep * r);
  }
  CHICANE_INLINE auto residual(auto, const auto& x, const auto& u) const {
    const auto& [px, py, pz, vx, vy, vz, roll, pitch, yaw] = x;
    const auto& [thrust, p, q, r] = u;
    return std::make_tuple(0.3 * (px - goal[0]), 0.3 * (py - goal[1]), 0.3 * (pz - goal[2]), 0.1 * vx,
                           0.1 * vy, 0.1 * vz, 0.2 * roll, 0.2 * pitch, 0.2 * yaw, 0.1 * (thrust - kGravity),
                           0.1 * p, 0.1 * q, 0.1 * r);
  }
  CHICANE_INLINE auto terminal_residual(const auto& x) const {
    const auto& [px, py, pz, vx, vy, vz, roll, pitch, yaw] = x;
    return std::make_tuple(10.0 * (px - goal[0]), 10.0 * (py - goal[1]), 10.0 * (pz - goal[2]), 3.0 * vx,
                           3.0 * vy, 3.0 * vz, 3.0 * roll, 3.0 * pitch, 3.0 * yaw);
  }
  CHICANE_INLINE auto constraint(auto, const auto& x, const auto&) const {
    const auto inside = [&](const std::array<double, 3>& ball, double radius) {
      const auto dx = std::get<0>(x) - ball[0];
      const auto dy = std::get<1>(x) - ball[1];
      const auto dz = std::get<2>(x) - ball[2];
      return radius * radius - dx * dx - dy * dy - dz * dz;
    };
    return std::make_tuple(inside(ball_1, radius_1), inside(ball_2, radius_2));
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 100.0, .quadratic = 100.0}; }
  [[nodiscard]] std::array<double, 4> input_lower(int) const { return {2.0, -3.0, -3.0, -2.0}; }
  [[nodiscard]] std::array<double, 4> input_upper(int) const { return {20.0, 3.0, 3.0, 2.0}; }

  void draw(Random& random) {
    goal = {random.uniform(3.0, 5.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.5)};
    for (std::size_t i = 0; i < 3; ++i) {
      ball_1[i] = 0.35 * goal[i] + random.uniform(-0.3, 0.3);
      ball_2[i] = 0.7 * goal[i] + random.uniform(-0.3, 0.3);
    }
    radius_1 = random.uniform(0.3, 0.7);
    radius_2 = random.uniform(0.3, 0.6);
    start = {0.0,
             0.0,
             0.0,
             random.uniform(-0.5, 0.5),
             random.uniform(-0.5, 0.5),
             random.uniform(-0.5, 0.5),
             random.uniform(-0.3, 0.3),
             random.uniform(-0.3, 0.3),
             random.uniform(-1.5, 1.5)};
    idle = {kGravity, 0.0, 0.0, 0.0};
  }
};

/// A rocket lands upright on its engine, which can neither be shut off nor swivel far, and burns the mass it
/// carries. States: position [m], speeds [m/s], pitch [rad], its rate, mass [t]; inputs: thrust in units of
/// `unit` kN, swivel [rad].
struct RocketLanding : FamilyProblem<7, 2> {
  static constexpr std::string_view kName = "rocket landing";
  static constexpr int kNr = 6, kNe = 6, kNc = 2, kHorizon = 60;
  static constexpr double kGravity = 9.81, kLever = 8.0, kFlow = 0.00035;
  double step = 0.25;
  double least = 180.0, strongest = 600.0;  ///< thrust [kN]
  double unit = 1.0;                        ///< unit of the thrust [kN]: changes no answer
  double glide = 0.4;                       ///< least slope of the approach

  CHICANE_INLINE auto dynamics(auto, const auto& x, const auto& u) const {
    const auto& [px, pz, vx, vz, pitch, rate, mass] = x;
    const auto thrust = unit * std::get<0>(u);
    const auto& swivel = std::get<1>(u);
    const auto push = thrust / mass;
    const auto wx = vx + step * (push * sin(pitch + swivel));
    const auto wz = vz + step * (push * cos(pitch + swivel) - kGravity);
    const auto w = rate - step * (kLever * push * sin(swivel) * (1.0 / 120.0));
    return std::make_tuple(px + step * wx, pz + step * wz, wx, wz, pitch + step * w, w,
                           mass - (step * kFlow) * thrust);
  }
  CHICANE_INLINE auto residual(auto, const auto& x, const auto& u) const {
    const auto& [px, pz, vx, vz, pitch, rate, mass] = x;
    return std::make_tuple(0.02 * px, 0.02 * vx, 1.0 * pitch, 1.0 * rate, (0.003 * unit) * std::get<0>(u),
                           2.0 * std::get<1>(u));
  }
  CHICANE_INLINE auto terminal_residual(const auto& x) const {
    const auto& [px, pz, vx, vz, pitch, rate, mass] = x;
    return std::make_tuple(3.0 * px, 3.0 * pz, 3.0 * vx, 3.0 * vz, 30.0 * pitch, 30.0 * rate);
  }
  CHICANE_INLINE auto constraint(auto, const auto& x,
                                 const auto&) const {  // stay inside a cone above the pad
    const auto& [px, pz, vx, vz, pitch, rate, mass] = x;
    return std::make_tuple(glide * px - pz - 1.0, -glide * px - pz - 1.0);
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 10.0, .quadratic = 10.0}; }
  [[nodiscard]] std::array<double, 2> input_lower(int) const { return {least / unit, -0.2}; }
  [[nodiscard]] std::array<double, 2> input_upper(int) const { return {strongest / unit, 0.2}; }

  void draw(Random& random) {
    const double mass = random.uniform(22.0, 30.0);
    const double height = random.uniform(400.0, 700.0);
    unit = random.uniform() < 0.5 ? 1.0 : 0.001;  // kN or N
    glide = random.uniform(0.2, 0.6);
    strongest = mass * kGravity * random.uniform(1.7, 2.2);
    least = 0.4 * strongest;
    start = {random.uniform(-150.0, 150.0),
             height,
             random.uniform(-20.0, 20.0),
             -height * random.uniform(0.10, 0.14),
             random.uniform(-0.1, 0.1),
             0.0,
             mass};
    goal = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.95 * mass};
    idle = {mass * kGravity / unit, 0.0};
  }
};

/// A glider perches: it dives, pulls up and arrives slowly. States: position [m], speed [m/s], path angle
/// [rad], lift coefficient; input: its rate of change.
struct Glider : FamilyProblem<5, 1> {
  static constexpr std::string_view kName = "glider pulls up to a perch";
  static constexpr int kNr = 4, kNe = 4, kNc = 3, kHorizon = 60;
  static constexpr double kGravity = 9.81;
  double step = 0.05, drag = 0.03, induced = 0.06, area = 0.35;

  CHICANE_INLINE auto dynamics(auto, const auto& x, const auto& u) const {
    const auto& [px, pz, speed, path, lift] = x;
    const auto& [turn] = u;
    const auto pressure = area * speed;
    const auto v = speed - step * (pressure * speed * (drag + induced * lift * lift) + kGravity * sin(path));
    const auto g = path + step * (pressure * lift - kGravity * (cos(path) / speed));
    return std::make_tuple(px + step * (v * cos(g)), pz + step * (v * sin(g)), v, g, lift + step * turn);
  }
  CHICANE_INLINE auto residual(auto, const auto& x, const auto& u) const {
    const auto& [px, pz, speed, path, lift] = x;
    return std::make_tuple(0.02 * (px - goal[0]), 0.02 * (pz - goal[1]), 0.1 * lift, 0.05 * std::get<0>(u));
  }
  CHICANE_INLINE auto terminal_residual(const auto& x) const {
    const auto& [px, pz, speed, path, lift] = x;
    return std::make_tuple(5.0 * (px - goal[0]), 5.0 * (pz - goal[1]), 1.0 * (speed - 2.0), 1.0 * path);
  }
  CHICANE_INLINE auto constraint(auto, const auto& x, const auto&) const {
    const auto& [px, pz, speed, path, lift] = x;
    return std::make_tuple(lift - 1.4, -1.0 - lift, 1.0 - speed);
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 50.0, .quadratic = 50.0}; }

  void draw(Random& random) {
    drag = random.uniform(0.02, 0.05);
    induced = random.uniform(0.04, 0.1);
    goal = {random.uniform(10.0, 16.0), random.uniform(-1.0, 2.5), 3.0, 0.0, 0.5};
    most = {random.uniform(4.0, 12.0)};
    start = {0.0, random.uniform(0.0, 2.0), random.uniform(5.0, 8.0), random.uniform(-0.4, 0.2),
             random.uniform(0.2, 0.6)};
  }
};

/// Goddard's rocket (1919) climbs as high as its fuel carries it through thin air, in a time that is free.
/// The best thrust is full, then between its bounds (a singular arc), then none. States: height above the
/// ground in a hundredth of the earth's radius, speed in a tenth of its unit, mass over the mass at the
/// start, duration in tenths of the unit of time; inputs: thrust over its bound, duration.
struct GoddardRocket : FamilyProblem<4, 2>, AllHard<1> {
  static constexpr std::string_view kName = "goddard's rocket";
  static constexpr int kNr = 1, kNe = 1, kNc = 1, kNec = 1, kHorizon = 60;
  static constexpr double kExhaust = 0.5, kDecay = 500.0;
  static constexpr bool kRecedes = false;  ///< a duration cannot be set twice
  double drag = 310.0, thrust = 3.5, dry = 0.6;

  auto dynamics(auto, const Numbers auto& x, const Numbers auto& u) const {
    const auto duration = x[3] + u[1];
    const auto step = duration * (0.1 / kHorizon);
    const auto rate = [&](const auto& y) {
      const auto distance = 1.0 + 0.01 * y[0];
      const auto resistance = (0.01 * drag) * y[1] * y[1] * exp(-(0.01 * kDecay) * y[0]);
      return std::array{step * 10.0 * y[1],
                        step * 10.0 * ((thrust * u[0] - resistance) / y[2] - 1.0 / (distance * distance)),
                        step * (-(thrust / kExhaust) * u[0])};
    };
    const auto next = runge_kutta_4(std::array{x[0], x[1], x[2]}, 1.0, rate);
    return std::array{next[0], next[1], next[2], duration};
  }
  auto residual(auto, const Numbers auto&, const Numbers auto& u) const { return std::array{0.01 * u[0]}; }
  auto terminal_residual(const Numbers auto& x) const {
    return std::array{3.0 - x[0]};  // higher than it gets
  }
  auto terminal_constraint(const Numbers auto& x) const { return std::array{dry - x[2]}; }
  auto constraint(auto, const Numbers auto& x, const Numbers auto&) const {
    return std::array{-x[1]};  // it does not fall
  }
  [[nodiscard]] std::array<double, 2> input_lower(int k) const { return {0.0, k == 0 ? 0.5 : 0.0}; }
  [[nodiscard]] std::array<double, 2> input_upper(int k) const { return {1.0, k == 0 ? 4.0 : 0.0}; }

  void draw(Random& random) {
    drag = random.uniform(200.0, 400.0);
    thrust = random.uniform(2.5, 4.0);
    dry = random.uniform(0.55, 0.7);
    start = {0.0, 0.0, 1.0, 0.0};
    goal = {1.0, 0.0, dry, 1.5};
    idle = {0.5, 1.5};
  }
};

}  // namespace chicane::bench
