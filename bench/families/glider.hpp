// SPDX-License-Identifier: MIT
#pragma once

#include "families/family.hpp"

namespace chicane::bench {

/// A glider perches: it dives, pulls up and arrives slowly. States: position [m], speed [m/s], path angle
/// [rad], lift coefficient; input: its rate of change.
struct Glider {
  static constexpr std::string_view kName = "glider pulls up to a perch";
  static constexpr int kNx = 5, kNu = 1, kNr = 4, kNe = 4, kNc = 3, kHorizon = 60;
  static constexpr double kGravity = 9.81;
  double step = 0.05, drag = 0.03, induced = 0.06, area = 0.35, perch_x = 10.0, perch_z = 1.0, most = 8.0;

  template <class K, class X, class U>
  CHICANE_INLINE auto dynamics(K, const X& x, const U& u) const {
    const auto& [px, pz, speed, path, lift] = x;
    const auto& [turn] = u;
    const auto pressure = area * speed;
    const auto v = speed - step * (pressure * speed * (drag + induced * lift * lift) + kGravity * sin(path));
    const auto g = path + step * (pressure * lift - kGravity * (cos(path) / speed));
    return std::make_tuple(px + step * (v * cos(g)), pz + step * (v * sin(g)), v, g, lift + step * turn);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto residual(K, const X& x, const U& u) const {
    const auto& [px, pz, speed, path, lift] = x;
    return std::make_tuple(0.02 * (px - perch_x), 0.02 * (pz - perch_z), 0.1 * lift, 0.05 * std::get<0>(u));
  }
  template <class X>
  CHICANE_INLINE auto terminal_residual(const X& x) const {
    const auto& [px, pz, speed, path, lift] = x;
    return std::make_tuple(5.0 * (px - perch_x), 5.0 * (pz - perch_z), 1.0 * (speed - 2.0), 1.0 * path);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto constraint(K, const X& x, const U&) const {
    const auto& [px, pz, speed, path, lift] = x;
    return std::make_tuple(lift - 1.4, -1.0 - lift, 1.0 - speed);
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 50.0, .quadratic = 50.0}; }
  [[nodiscard]] std::array<double, 1> input_lower(int) const { return {-most}; }
  [[nodiscard]] std::array<double, 1> input_upper(int) const { return {most}; }

  static FamilyInstance<Glider> make(Random& random) {
    FamilyInstance<Glider> instance;
    Glider& p = instance.problem;
    p.drag = random.uniform(0.02, 0.05);
    p.induced = random.uniform(0.04, 0.1);
    p.perch_x = random.uniform(10.0, 16.0);
    p.perch_z = random.uniform(-1.0, 2.5);
    p.most = random.uniform(4.0, 12.0);
    instance.start = {0.0, random.uniform(0.0, 2.0), random.uniform(5.0, 8.0), random.uniform(-0.4, 0.2),
                      random.uniform(0.2, 0.6)};
    instance.goal = {p.perch_x, p.perch_z, 3.0, 0.0, 0.5};
    return instance;
  }
};

}  // namespace chicane::bench
