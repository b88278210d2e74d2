// SPDX-License-Identifier: MIT
#pragma once

#include "families/arm.hpp"
#include "families/family.hpp"

namespace chicane::bench {

/// An arm with a motor in its elbow alone swings itself up. States: angle of the upper link from hanging
/// [rad], angle of the elbow, and their rates; input: torque of the elbow [N m].
struct Acrobot {
  static constexpr std::string_view kName = "acrobot swing-up";
  static constexpr int kNx = 4, kNu = 1, kNr = 5, kNe = 4, kNc = 0, kHorizon = 60;
  static constexpr double kStep = 0.05;
  Arm body{};
  double most = 10.0;

  template <class K, class T>
  std::array<T, 4> dynamics(K, const std::array<T, 4>& x, const std::array<T, 1>& u) const {
    return runge_kutta_4(x, kStep, [&](const std::array<T, 4>& y) {
      return Arm::rate<T>(body, {y[0] - 0.5 * kPi, y[1], y[2], y[3]}, {T(0.0), u[0]});
    });
  }
  template <class K, class T>
  std::array<T, 5> residual(K, const std::array<T, 4>& x, const std::array<T, 1>& u) const {
    return {0.1 * (x[0] - kPi), 0.1 * x[1], 0.02 * x[2], 0.02 * x[3], 0.03 * u[0]};
  }
  template <class T>
  std::array<T, 4> terminal_residual(const std::array<T, 4>& x) const {
    return {10.0 * (x[0] - kPi), 10.0 * x[1], 2.0 * x[2], 2.0 * x[3]};
  }
  [[nodiscard]] std::array<double, 1> input_lower(int) const { return {-most}; }
  [[nodiscard]] std::array<double, 1> input_upper(int) const { return {most}; }

  static FamilyInstance<Acrobot> make(Random& random) {
    FamilyInstance<Acrobot> instance;
    Acrobot& p = instance.problem;
    p.body.mass_1 = random.uniform(0.7, 1.3);
    p.body.mass_2 = random.uniform(0.7, 1.3);
    p.body.length_1 = random.uniform(0.4, 0.6);
    p.body.length_2 = random.uniform(0.4, 0.6);
    p.most = random.uniform(5.0, 12.0);
    instance.start = {random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 0.0, 0.0};
    instance.goal = {kPi, 0.0, 0.0, 0.0};
    return instance;
  }
};

}  // namespace chicane::bench
