// SPDX-License-Identifier: MIT
#pragma once

#include "families/family.hpp"

namespace chicane::bench {

/// An arm with two links in a vertical plane reaches a point with its hand, round a ball. States: joint
/// angles [rad], their rates; inputs: torques [N m].
struct Arm {
  static constexpr std::string_view kName = "arm round a ball";
  static constexpr int kNx = 4, kNu = 2, kNr = 6, kNe = 4, kNc = 3, kHorizon = 50;
  static constexpr double kStep = 0.03, kGravity = 9.81;
  double length_1 = 0.5, length_2 = 0.4, mass_1 = 2.0, mass_2 = 1.0, most_1 = 30.0, most_2 = 12.0;
  std::array<double, 2> target{0.5, 0.5}, ball{0.6, 0.0};
  double radius = 0.15;

  template <class T>
  static std::array<T, 4> rate(const Arm& p, const std::array<T, 4>& x, const std::array<T, 2>& u) {
    const double r1 = 0.5 * p.length_1, r2 = 0.5 * p.length_2;
    const double i1 = p.mass_1 * p.length_1 * p.length_1 / 12.0,
                 i2 = p.mass_2 * p.length_2 * p.length_2 / 12.0;
    const double a = i1 + i2 + p.mass_1 * r1 * r1 + p.mass_2 * (p.length_1 * p.length_1 + r2 * r2);
    const double b = p.mass_2 * p.length_1 * r2;
    const double d = i2 + p.mass_2 * r2 * r2;
    const T s2 = sin(x[1]), c2 = cos(x[1]);
    const T m11 = a + 2.0 * b * c2, m12 = d + b * c2;
    const T sway = b * s2;
    const T g2 = (p.mass_2 * kGravity * r2) * cos(x[0] + x[1]);
    const T g1 = ((p.mass_1 * r1 + p.mass_2 * p.length_1) * kGravity) * cos(x[0]) + g2;
    const T f1 = u[0] + sway * x[3] * (2.0 * x[2] + x[3]) - g1 - 0.2 * x[2];
    const T f2 = u[1] - sway * x[2] * x[2] - g2 - 0.2 * x[3];
    const T det = m11 * d - m12 * m12;
    return {x[2], x[3], (d * f1 - m12 * f2) / det, (m11 * f2 - m12 * f1) / det};
  }
  template <class T>
  std::array<T, 2> hand(const std::array<T, 4>& x, double share) const {
    return {length_1 * cos(x[0]) + (share * length_2) * cos(x[0] + x[1]),
            length_1 * sin(x[0]) + (share * length_2) * sin(x[0] + x[1])};
  }
  template <class K, class T>
  std::array<T, 4> dynamics(K, const std::array<T, 4>& x, const std::array<T, 2>& u) const {
    return runge_kutta_4(x, kStep, [&](const std::array<T, 4>& y) { return rate<T>(*this, y, u); });
  }
  template <class K, class T>
  std::array<T, 6> residual(K, const std::array<T, 4>& x, const std::array<T, 2>& u) const {
    const auto at = hand(x, 1.0);
    return {1.0 * (at[0] - target[0]),
            1.0 * (at[1] - target[1]),
            0.05 * x[2],
            0.05 * x[3],
            0.01 * u[0],
            0.02 * u[1]};
  }
  template <class T>
  std::array<T, 4> terminal_residual(const std::array<T, 4>& x) const {
    const auto at = hand(x, 1.0);
    return {30.0 * (at[0] - target[0]), 30.0 * (at[1] - target[1]), 3.0 * x[2], 3.0 * x[3]};
  }
  template <class K, class T>
  std::array<T, 3> constraint(K, const std::array<T, 4>& x, const std::array<T, 2>&) const {
    std::array<T, 3> inside;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = hand(x, 0.2 + 0.4 * static_cast<double>(i));
      const T dx = at[0] - ball[0], dy = at[1] - ball[1];
      inside[i] = radius * radius - dx * dx - dy * dy;
    }
    return inside;
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 200.0, .quadratic = 100.0}; }
  [[nodiscard]] std::array<double, 2> input_lower(int) const { return {-most_1, -most_2}; }
  [[nodiscard]] std::array<double, 2> input_upper(int) const { return {most_1, most_2}; }

  static FamilyInstance<Arm> make(Random& random) {
    FamilyInstance<Arm> instance;
    Arm& p = instance.problem;
    p.most_1 = random.uniform(20.0, 40.0);
    p.most_2 = random.uniform(6.0, 15.0);
    const double from = random.uniform(-1.8, -0.8), to = random.uniform(0.3, 1.8);
    const double elbow = random.uniform(0.2, 1.2);
    instance.start = {from, elbow, 0.0, 0.0};
    instance.goal = {to, random.uniform(0.2, 1.2), 0.0, 0.0};
    p.target = p.hand<double>(instance.goal, 1.0);
    const double way = from + random.uniform(0.3, 0.7) * (to - from) + 0.4, far = random.uniform(0.5, 0.9);
    p.ball = {far * cos(way), far * sin(way)};
    p.radius = random.uniform(0.08, 0.2);
    return instance;
  }
};

}  // namespace chicane::bench
