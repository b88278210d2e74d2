// SPDX-License-Identifier: MIT
#pragma once

#include "families/family.hpp"

namespace chicane::bench {

/// A chain of springs and masses hangs from a wall; the hand at its other end calms it (after Wirsching,
/// Bock, Diehl 2006, in the plane). States: positions of two masses and the hand, speeds of the masses;
/// inputs: speed of the hand.
struct ChainOfMasses {
  static constexpr std::string_view kName = "chain of masses";
  static constexpr int kNx = 10, kNu = 2, kNr = 12, kNe = 10, kNc = 3, kHorizon = 40;
  static constexpr double kStep = 0.2, kGravity = 9.81;
  double stiffness = 1.0, mass = 0.03, rest = 0.033, most = 1.0, floor = -0.8;
  std::array<double, 2> hand{0.5, 0.0};

  template <class T>
  static std::array<T, 10> rate(const ChainOfMasses& p, const std::array<T, 10>& x,
                                const std::array<T, 2>& u) {
    const auto pull = [&](const T& dx, const T& dy) {  // of a spring, along its length
      const T length = sqrt(dx * dx + dy * dy + 1e-6);
      const T share = p.stiffness * (1.0 - p.rest / length);
      return std::array<T, 2>{share * dx, share * dy};
    };
    const auto a = pull(x[0], x[1]);
    const auto b = pull(x[2] - x[0], x[3] - x[1]);
    const auto c = pull(x[4] - x[2], x[5] - x[3]);
    const double w = 1.0 / p.mass;
    return {x[6],
            x[7],
            x[8],
            x[9],
            u[0],
            u[1],
            w * (b[0] - a[0]) - 0.5 * x[6],
            w * (b[1] - a[1]) - kGravity - 0.5 * x[7],
            w * (c[0] - b[0]) - 0.5 * x[8],
            w * (c[1] - b[1]) - kGravity - 0.5 * x[9]};
  }
  template <class K, class T>
  std::array<T, 10> dynamics(K, const std::array<T, 10>& x, const std::array<T, 2>& u) const {
    std::array<T, 10> next = x;
    for (int part = 0; part < 2; ++part)
      next =
          runge_kutta_4(next, 0.5 * kStep, [&](const std::array<T, 10>& y) { return rate<T>(*this, y, u); });
    return next;
  }
  template <class K, class T>
  std::array<T, 12> residual(K, const std::array<T, 10>& x, const std::array<T, 2>& u) const {
    std::array<T, 12> r;
    for (std::size_t i = 0; i < 4; ++i) r[i] = T(0.0);
    r[4] = 1.5 * (x[4] - hand[0]);
    r[5] = 1.5 * (x[5] - hand[1]);
    for (std::size_t i = 6; i < 10; ++i) r[i] = 1.0 * x[i];
    r[10] = 0.1 * u[0];
    r[11] = 0.1 * u[1];
    return r;
  }
  template <class T>
  std::array<T, 10> terminal_residual(const std::array<T, 10>& x) const {
    std::array<T, 10> r;
    for (std::size_t i = 0; i < 4; ++i) r[i] = T(0.0);
    r[4] = 5.0 * (x[4] - hand[0]);
    r[5] = 5.0 * (x[5] - hand[1]);
    for (std::size_t i = 6; i < 10; ++i) r[i] = 3.0 * x[i];
    return r;
  }
  template <class K, class T>
  std::array<T, 3> constraint(K, const std::array<T, 10>& x, const std::array<T, 2>&) const {
    return {floor - x[1], floor - x[3], floor - x[5]};
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 50.0, .quadratic = 50.0}; }
  [[nodiscard]] std::array<double, 2> input_lower(int) const { return {-most, -most}; }
  [[nodiscard]] std::array<double, 2> input_upper(int) const { return {most, most}; }

  static FamilyInstance<ChainOfMasses> make(Random& random) {
    FamilyInstance<ChainOfMasses> instance;
    ChainOfMasses& p = instance.problem;
    p.stiffness = random.uniform(0.8, 1.5);
    p.hand = {random.uniform(0.4, 1.0), random.uniform(-0.2, 0.3)};
    p.floor = random.uniform(-0.9, -0.6);
    const double x = random.uniform(0.2, 1.2), y = random.uniform(-0.5, 0.5);
    instance.start = {x / 3 + random.uniform(-0.1, 0.1),
                      y / 3 - 0.3,
                      2 * x / 3 + random.uniform(-0.1, 0.1),
                      2 * y / 3 - 0.3,
                      x,
                      y,
                      random.uniform(-1.0, 1.0),
                      random.uniform(-1.0, 1.0),
                      random.uniform(-1.0, 1.0),
                      random.uniform(-1.0, 1.0)};
    instance.goal = {p.hand[0] / 3,
                     p.hand[1] / 3 - 0.4,
                     2 * p.hand[0] / 3,
                     2 * p.hand[1] / 3 - 0.4,
                     p.hand[0],
                     p.hand[1],
                     0,
                     0,
                     0,
                     0};
    return instance;
  }
};

}  // namespace chicane::bench
