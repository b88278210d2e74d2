// SPDX-License-Identifier: MIT
#pragma once

#include "families/family.hpp"

namespace chicane::bench {

/// Goddard's rocket (1919) climbs as high as its fuel carries it through thin air, in a time that is free.
/// The best thrust is full, then between its bounds (a singular arc), then none. States: height above the
/// ground in a hundredth of the earth's radius, speed in a tenth of its unit, mass over the mass at the
/// start, duration in tenths of the unit of time; inputs: thrust over its bound, duration.
struct GoddardRocket {
  static constexpr std::string_view kName = "goddard's rocket";
  static constexpr int kNx = 4, kNu = 2, kNr = 1, kNe = 1, kNc = 1, kNec = 1, kHorizon = 60;
  static constexpr double kExhaust = 0.5, kDecay = 500.0;
  static constexpr bool kRecedes = false;  ///< a duration cannot be set twice
  double drag = 310.0, thrust = 3.5, dry = 0.6;

  template <class K, class T>
  std::array<T, 4> dynamics(K, const std::array<T, 4>& x, const std::array<T, 2>& u) const {
    const T duration = x[3] + u[1];
    const T step = duration * (0.1 / kHorizon);
    const auto rate = [&](const std::array<T, 3>& y) {
      const T distance = 1.0 + 0.01 * y[0];
      const T resistance = (0.01 * drag) * y[1] * y[1] * exp(-(0.01 * kDecay) * y[0]);
      return std::array<T, 3>{
          step * 10.0 * y[1],
          step * 10.0 * ((thrust * u[0] - resistance) / y[2] - 1.0 / (distance * distance)),
          step * (-(thrust / kExhaust) * u[0])};
    };
    const auto next = runge_kutta_4(std::array<T, 3>{x[0], x[1], x[2]}, 1.0, rate);
    return {next[0], next[1], next[2], duration};
  }
  template <class K, class T>
  std::array<T, 1> residual(K, const std::array<T, 4>&, const std::array<T, 2>& u) const {
    return {0.01 * u[0]};
  }
  template <class T>
  std::array<T, 1> terminal_residual(const std::array<T, 4>& x) const {
    return {3.0 - x[0]};  // higher than it gets
  }
  template <class T>
  std::array<T, 1> terminal_constraint(const std::array<T, 4>& x) const {
    return {dry - x[2]};
  }
  template <class K, class T>
  std::array<T, 1> constraint(K, const std::array<T, 4>& x, const std::array<T, 2>&) const {
    return {-x[1]};  // it does not fall
  }
  [[nodiscard]] bool is_hard(int) const { return true; }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 1.0, .quadratic = 1.0}; }
  [[nodiscard]] std::array<double, 2> input_lower(int k) const { return {0.0, k == 0 ? 0.5 : 0.0}; }
  [[nodiscard]] std::array<double, 2> input_upper(int k) const { return {1.0, k == 0 ? 4.0 : 0.0}; }

  static FamilyInstance<GoddardRocket> make(Random& random) {
    FamilyInstance<GoddardRocket> instance;
    GoddardRocket& p = instance.problem;
    p.drag = random.uniform(200.0, 400.0);
    p.thrust = random.uniform(2.5, 4.0);
    p.dry = random.uniform(0.55, 0.7);
    instance.start = {0.0, 0.0, 1.0, 0.0};
    instance.goal = {1.0, 0.0, p.dry, 1.5};
    instance.idle = {0.5, 1.5};
    return instance;
  }
};

}  // namespace chicane::bench
