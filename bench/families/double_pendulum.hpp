// SPDX-License-Identifier: MIT
#pragma once

#include "families/family.hpp"

namespace chicane::bench {

/// Two rods standing on a cart, one on the other, are caught and held upright: doubly unstable. States: cart
/// [m], angles from upright [rad], and their rates; input: push [N].
struct DoublePendulum {
  static constexpr std::string_view kName = "unstable balance of two rods";
  static constexpr int kNx = 6, kNu = 1, kNr = 7, kNe = 6, kNc = 2, kHorizon = 60;
  static constexpr double kStep = 0.03, kGravity = 9.81;
  double cart = 1.0, lower = 0.3, upper = 0.2, length_1 = 0.5, length_2 = 0.4, most = 30.0, room = 0.8;

  template <class T>
  static std::array<T, 6> rate(const DoublePendulum& p, const std::array<T, 6>& x, const T& push) {
    // M(q) q'' = f(q, q') of two point masses on rods, solved by elimination.
    const double d1 = p.cart + p.lower + p.upper;
    const double d2 = (p.lower + p.upper) * p.length_1;
    const double d3 = p.upper * p.length_2;
    const double d4 = (p.lower + p.upper) * p.length_1 * p.length_1;
    const double d5 = p.upper * p.length_1 * p.length_2;
    const double d6 = p.upper * p.length_2 * p.length_2;
    const T s1 = sin(x[1]), c1 = cos(x[1]), s2 = sin(x[2]), c2 = cos(x[2]);
    const T c12 = c1 * c2 + s1 * s2, s12 = s1 * c2 - c1 * s2;
    const T a12 = d2 * c1, a13 = d3 * c2, a23 = d5 * c12;
    const T f1 = push + d2 * s1 * x[4] * x[4] + d3 * s2 * x[5] * x[5] - 0.1 * x[3];
    const T f2 = d2 * kGravity * s1 - d5 * s12 * x[5] * x[5];
    const T f3 = d3 * kGravity * s2 + d5 * s12 * x[4] * x[4];
    const T b22 = d4 - a12 * a12 * (1.0 / d1), b23 = a23 - a12 * a13 * (1.0 / d1),
            b33 = d6 - a13 * a13 * (1.0 / d1);
    const T g2 = f2 - a12 * f1 * (1.0 / d1), g3 = f3 - a13 * f1 * (1.0 / d1);
    const T det = b22 * b33 - b23 * b23;
    const T q2 = (b33 * g2 - b23 * g3) / det;
    const T q3 = (b22 * g3 - b23 * g2) / det;
    return {x[3], x[4], x[5], (f1 - a12 * q2 - a13 * q3) * (1.0 / d1), q2, q3};
  }
  template <class K, class T>
  std::array<T, 6> dynamics(K, const std::array<T, 6>& x, const std::array<T, 1>& u) const {
    return runge_kutta_4(x, kStep, [&](const std::array<T, 6>& y) { return rate<T>(*this, y, u[0]); });
  }
  template <class K, class T>
  std::array<T, 7> residual(K, const std::array<T, 6>& x, const std::array<T, 1>& u) const {
    return {1.0 * x[0], 3.0 * x[1], 3.0 * x[2], 0.1 * x[3], 0.1 * x[4], 0.1 * x[5], 0.05 * u[0]};
  }
  template <class T>
  std::array<T, 6> terminal_residual(const std::array<T, 6>& x) const {
    return {5.0 * x[0], 20.0 * x[1], 20.0 * x[2], 3.0 * x[3], 5.0 * x[4], 5.0 * x[5]};
  }
  template <class K, class T>
  std::array<T, 2> constraint(K, const std::array<T, 6>& x, const std::array<T, 1>&) const {
    return {x[0] - room, -room - x[0]};
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 100.0, .quadratic = 100.0}; }
  [[nodiscard]] std::array<double, 1> input_lower(int) const { return {-most}; }
  [[nodiscard]] std::array<double, 1> input_upper(int) const { return {most}; }

  static FamilyInstance<DoublePendulum> make(Random& random) {
    FamilyInstance<DoublePendulum> instance;
    DoublePendulum& p = instance.problem;
    p.lower = random.uniform(0.2, 0.4);
    p.upper = random.uniform(0.1, 0.3);
    p.length_1 = random.uniform(0.4, 0.7);
    p.length_2 = random.uniform(0.3, 0.6);
    p.most = random.uniform(20.0, 40.0);
    p.room = random.uniform(0.6, 1.2);
    instance.start = {random.uniform(-0.4, 0.4), random.uniform(-0.25, 0.25), random.uniform(-0.25, 0.25),
                      random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5),   random.uniform(-0.5, 0.5)};
    return instance;
  }
};

}  // namespace chicane::bench
