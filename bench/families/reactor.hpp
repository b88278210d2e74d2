// SPDX-License-Identifier: MIT
#pragma once

#include "families/family.hpp"

namespace chicane::bench {

/// A stirred tank with an exothermic reaction is brought to an unstable operating point by its coolant
/// (Hicks, Ray 1971). States: concentration and temperature, scaled; its flow, whose change is the
/// input and has bounds, is a third state.
struct Reactor {
  static constexpr std::string_view kName = "stirred tank reactor";
  static constexpr int kNx = 3, kNu = 1, kNr = 3, kNe = 2, kNc = 3, kHorizon = 80;
  static constexpr double kStep = 0.15;
  double concentration = 0.4, temperature = 0.7, flow = 0.0, hottest = 0.8, rate = 60.0;
  static constexpr double kMostFlow = 700.0;

  template <class T>
  static std::array<T, 2> change(const std::array<T, 2>& x, const T& coolant) {
    const T reaction = 300.0 * x[0] * exp(-5.0 / x[1]);
    return {(1.0 - x[0]) * (1.0 / 20.0) - reaction,
            (0.3947 - x[1]) * (1.0 / 20.0) + reaction - 1.95e-4 * coolant * (x[1] - 0.3816)};
  }
  template <class K, class T>
  std::array<T, 3> dynamics(K, const std::array<T, 3>& x, const std::array<T, 1>& u) const {
    std::array<T, 2> y{x[0], x[1]};
    for (int part = 0; part < 2; ++part)
      y = runge_kutta_4(y, 5.0 * kStep, [&](const std::array<T, 2>& z) { return change<T>(z, x[2] + u[0]); });
    return {y[0], y[1], x[2] + u[0]};
  }
  template <class K, class T>
  std::array<T, 3> residual(K, const std::array<T, 3>& x, const std::array<T, 1>& u) const {
    return {10.0 * (x[0] - concentration), 10.0 * (x[1] - temperature), 0.002 * (x[2] + u[0] - flow)};
  }
  template <class T>
  std::array<T, 2> terminal_residual(const std::array<T, 3>& x) const {
    return {50.0 * (x[0] - concentration), 50.0 * (x[1] - temperature)};
  }
  template <class K, class T>
  std::array<T, 3> constraint(K, const std::array<T, 3>& x, const std::array<T, 1>& u) const {
    const T share = (x[2] + u[0]) / kMostFlow;
    return {x[1] - hottest, share - 1.0, -share};
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 100.0, .quadratic = 1000.0}; }
  [[nodiscard]] std::array<double, 1> input_lower(int) const { return {-rate}; }
  [[nodiscard]] std::array<double, 1> input_upper(int) const { return {rate}; }

  static FamilyInstance<Reactor> make(Random& random) {
    FamilyInstance<Reactor> instance;
    Reactor& p = instance.problem;
    p.temperature = random.uniform(0.60, 0.72);
    const double reaction = 300.0 * exp(-5.0 / p.temperature);
    p.concentration = (1.0 / 20.0) / (1.0 / 20.0 + reaction);
    p.flow =
        ((0.3947 - p.temperature) / 20.0 + reaction * p.concentration) / (1.95e-4 * (p.temperature - 0.3816));
    p.hottest = p.temperature + random.uniform(0.02, 0.1);
    p.rate = random.uniform(30.0, 120.0);
    const double last = random.uniform(100.0, 400.0);
    instance.start = {random.uniform(0.1, 0.9), random.uniform(0.45, 0.8), last};
    instance.goal = {p.concentration, p.temperature, last};
    instance.idle = {0.0};
    return instance;
  }
};

}  // namespace chicane::bench
