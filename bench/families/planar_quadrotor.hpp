// SPDX-License-Identifier: MIT
#pragma once

#include "families/family.hpp"

namespace chicane::bench {

/// A planar quadrotor flies past a round obstacle that stands about in its way. States: position [m], pitch
/// [rad], and their rates; inputs: the two rotors' thrusts [N].
struct PlanarQuadrotor {
  static constexpr std::string_view kName = "planar quadrotor past an obstacle";
  static constexpr int kNx = 6, kNu = 2, kNr = 8, kNe = 6, kNc = 2, kHorizon = 50;
  static constexpr double kStep = 0.05, kGravity = 9.81, kArm = 0.2;
  double mass = 1.0, inertia = 0.02, most = 10.0;
  double goal_x = 4.0, goal_z = 1.0, obstacle_x = 2.0, obstacle_z = 0.5, radius = 0.6;

  template <class K, class X, class U>
  CHICANE_INLINE auto dynamics(K, const X& x, const U& u) const {
    const auto& [px, pz, pitch, vx, vz, rate] = x;
    const auto& [left, right] = u;
    const auto lift = (left + right) * (1.0 / mass);
    const auto wx = vx + kStep * (lift * sin(pitch));
    const auto wz = vz + kStep * (lift * cos(pitch) - kGravity);
    const auto w = rate + (kStep * kArm / inertia) * (left - right);
    return std::make_tuple(px + kStep * wx, pz + kStep * wz, pitch + kStep * w, wx, wz, w);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto residual(K, const X& x, const U& u) const {
    const auto& [px, pz, pitch, vx, vz, rate] = x;
    const auto& [left, right] = u;
    const double hover = 0.5 * mass * kGravity;
    return std::make_tuple(0.3 * (px - goal_x), 0.3 * (pz - goal_z), 0.1 * pitch, 0.1 * vx, 0.1 * vz,
                           0.1 * rate, 0.1 * (left - hover), 0.1 * (right - hover));
  }
  template <class X>
  CHICANE_INLINE auto terminal_residual(const X& x) const {
    const auto& [px, pz, pitch, vx, vz, rate] = x;
    return std::make_tuple(10.0 * (px - goal_x), 10.0 * (pz - goal_z), 5.0 * pitch, 5.0 * vx, 5.0 * vz,
                           2.0 * rate);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto constraint(K, const X& x, const U&) const {  // outside the obstacle, above the ground
    const auto dx = std::get<0>(x) - obstacle_x;
    const auto dz = std::get<1>(x) - obstacle_z;
    return std::make_tuple(radius * radius - dx * dx - dz * dz, -1.0 - std::get<1>(x));
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 200.0, .quadratic = 100.0}; }
  [[nodiscard]] std::array<double, 2> input_lower(int) const { return {0.0, 0.0}; }
  [[nodiscard]] std::array<double, 2> input_upper(int) const { return {most, most}; }

  static FamilyInstance<PlanarQuadrotor> make(Random& random) {
    FamilyInstance<PlanarQuadrotor> instance;
    PlanarQuadrotor& p = instance.problem;
    p.mass = random.uniform(0.7, 1.2);
    p.inertia = random.uniform(0.01, 0.03);
    p.goal_x = random.uniform(3.0, 5.0);
    p.goal_z = random.uniform(-0.5, 1.5);
    p.obstacle_x = p.goal_x * random.uniform(0.35, 0.65);
    p.obstacle_z = 0.5 * p.goal_z + random.uniform(-0.4, 0.4);
    p.radius = random.uniform(0.3, 0.8);
    instance.start = {
        0.0, 0.0, random.uniform(-0.3, 0.3), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 0.0};
    instance.goal = {p.goal_x, p.goal_z, 0.0, 0.0, 0.0, 0.0};
    instance.idle = {0.5 * p.mass * kGravity, 0.5 * p.mass * kGravity};
    return instance;
  }
};

}  // namespace chicane::bench
