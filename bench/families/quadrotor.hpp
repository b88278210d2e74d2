// SPDX-License-Identifier: MIT
#pragma once

#include "families/family.hpp"

namespace chicane::bench {

/// A quadrotor with attitude control inside flies in space past two balls. States: position [m], velocity
/// [m/s], roll, pitch and yaw [rad]; inputs: thrust over mass [m/s²] and the rates of the three angles
/// [rad/s].
struct Quadrotor {
  static constexpr std::string_view kName = "quadrotor past two balls";
  static constexpr int kNx = 9, kNu = 4, kNr = 13, kNe = 9, kNc = 2, kHorizon = 40;
  static constexpr double kStep = 0.06, kGravity = 9.81;
  std::array<double, 3> goal{4.0, 0.0, 1.0};
  std::array<double, 3> ball_1{1.5, 0.1, 0.3}, ball_2{3.0, -0.2, 0.8};
  double radius_1 = 0.6, radius_2 = 0.5;

  template <class K, class X, class U>
  CHICANE_INLINE auto dynamics(K, const X& x, const U& u) const {
    const auto& [px, py, pz, vx, vy, vz, roll, pitch, yaw] = x;
    const auto& [thrust, p, q, r] = u;
    const auto sr = sin(roll), cr = cos(roll), sp = sin(pitch), cp = cos(pitch), sy = sin(yaw), cy = cos(yaw);
    const auto wx = vx + kStep * (thrust * (cy * sp * cr + sy * sr) - 0.1 * vx);
    const auto wy = vy + kStep * (thrust * (sy * sp * cr - cy * sr) - 0.1 * vy);
    const auto wz = vz + kStep * (thrust * (cp * cr) - kGravity - 0.1 * vz);
    return std::make_tuple(px + kStep * wx, py + kStep * wy, pz + kStep * wz, wx, wy, wz, roll + kStep * p,
                           pitch + kStep * q, yaw + kStep * r);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto residual(K, const X& x, const U& u) const {
    const auto& [px, py, pz, vx, vy, vz, roll, pitch, yaw] = x;
    const auto& [thrust, p, q, r] = u;
    return std::make_tuple(0.3 * (px - goal[0]), 0.3 * (py - goal[1]), 0.3 * (pz - goal[2]), 0.1 * vx,
                           0.1 * vy, 0.1 * vz, 0.2 * roll, 0.2 * pitch, 0.2 * yaw, 0.1 * (thrust - kGravity),
                           0.1 * p, 0.1 * q, 0.1 * r);
  }
  template <class X>
  CHICANE_INLINE auto terminal_residual(const X& x) const {
    const auto& [px, py, pz, vx, vy, vz, roll, pitch, yaw] = x;
    return std::make_tuple(10.0 * (px - goal[0]), 10.0 * (py - goal[1]), 10.0 * (pz - goal[2]), 3.0 * vx,
                           3.0 * vy, 3.0 * vz, 3.0 * roll, 3.0 * pitch, 3.0 * yaw);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto constraint(K, const X& x, const U&) const {
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

  static FamilyInstance<Quadrotor> make(Random& random) {
    FamilyInstance<Quadrotor> instance;
    Quadrotor& p = instance.problem;
    p.goal = {random.uniform(3.0, 5.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.5)};
    for (std::size_t i = 0; i < 3; ++i) {
      p.ball_1[i] = 0.35 * p.goal[i] + random.uniform(-0.3, 0.3);
      p.ball_2[i] = 0.7 * p.goal[i] + random.uniform(-0.3, 0.3);
    }
    p.radius_1 = random.uniform(0.3, 0.7);
    p.radius_2 = random.uniform(0.3, 0.6);
    instance.start = {0.0,
                      0.0,
                      0.0,
                      random.uniform(-0.5, 0.5),
                      random.uniform(-0.5, 0.5),
                      random.uniform(-0.5, 0.5),
                      random.uniform(-0.3, 0.3),
                      random.uniform(-0.3, 0.3),
                      random.uniform(-1.5, 1.5)};
    instance.goal = {p.goal[0], p.goal[1], p.goal[2], 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    instance.idle = {kGravity, 0.0, 0.0, 0.0};
    return instance;
  }
};

}  // namespace chicane::bench
