// SPDX-License-Identifier: MIT
// The solver without a car: it swings up a pole on a cart, in 2 s of 50 steps of 40 ms, with forces of at
// most 20 N and a soft bound of 0.6 m on the position. The first guess is no force at all.

// [solver]
#include <cstdio>
#include <memory>
#include <tuple>

#include "chicane/base/math.hpp"
#include "chicane/solver/ocp_solver.hpp"

// The structured form: each variable has a type of its own, with the variables that it depends on, so zeros
// in the derivatives cost nothing and stages are evaluated in SIMD lanes. Plain doubles are accepted, too.
struct CartPole {
  static constexpr int kNx = 4, kNu = 1, kNr = 5, kNe = 4, kNc = 2;
  static constexpr double kStep = 0.04, kCart = 1.0, kPole = 0.2, kLength = 0.5, kGravity = 9.81;

  template <class K, class X, class U>  // x = (position, angle from hanging, speed, turn rate), u = push
  auto dynamics(K, const X& x, const U& u) const {
    const auto& [position, angle, speed, rate] = x;
    const auto& [push] = u;
    const auto s = sin(angle), c = cos(angle);
    const auto inertia = kCart + kPole * s * s;
    const auto swing = kPole * kLength * rate * rate;
    const auto v = speed + kStep * ((push + s * (swing + kPole * kGravity * c)) / inertia);
    const auto torque = push * c + swing * s * c + (kCart + kPole) * kGravity * s;
    const auto w = rate - kStep * (torque / (kLength * inertia));  // semi-implicit Euler
    return std::make_tuple(position + kStep * v, angle + kStep * w, v, w);
  }
  template <class K, class X, class U>
  auto residual(K, const X& x, const U& u) const {
    const auto& [position, angle, speed, rate] = x;
    return std::make_tuple(1.0 * position, angle - chicane::kPi, 0.1 * speed, 0.1 * rate,
                           0.05 * std::get<0>(u));
  }
  template <class X>
  auto terminal_residual(const X& x) const {
    const auto& [position, angle, speed, rate] = x;
    return std::make_tuple(10.0 * position, 30.0 * (angle - chicane::kPi), 5.0 * speed, 5.0 * rate);
  }
  template <class K, class X, class U>
  auto constraint(K, const X& x, const U&) const {
    return std::make_tuple(std::get<0>(x) - 0.6, -0.6 - std::get<0>(x));
  }
  chicane::solver::SoftPenalty soft_penalty(int) const { return {.linear = 100.0, .quadratic = 100.0}; }
  std::array<double, 1> input_lower(int) const { return {-20.0}; }
  std::array<double, 1> input_upper(int) const { return {20.0}; }
};

// The simple form: one scalar type for everything. Slower, but for any model, also one with branches.
struct PlainCartPole : CartPole {
  template <class T>
  using X = std::array<T, 4>;
  template <class T>
  using U = std::array<T, 1>;
  template <class T>
  std::array<T, 4> dynamics(int k, const X<T>& x, const U<T>& u) const {
    return chicane::solver::to_array<T>(CartPole::dynamics(k, x, u));
  }
  template <class T>
  std::array<T, 5> residual(int k, const X<T>& x, const U<T>& u) const {
    return chicane::solver::to_array<T>(CartPole::residual(k, x, u));
  }
  template <class T>
  std::array<T, 4> terminal_residual(const X<T>& x) const {
    return chicane::solver::to_array<T>(CartPole::terminal_residual(x));
  }
  template <class T>
  std::array<T, 2> constraint(int k, const X<T>& x, const U<T>& u) const {
    return chicane::solver::to_array<T>(CartPole::constraint(k, x, u));
  }
};

template <class Problem>
chicane::solver::SolveReport swing_up(chicane::solver::Trajectory<4, 1, 50>& t) {
  namespace solver = chicane::solver;
  const auto ocp =
      std::make_unique<solver::OcpSolver<Problem, 50>>(solver::SolverOptions{.max_iterations = 200});
  t = {.horizon = 50};
  return ocp->solve(Problem{}, {0.0, 0.0, 0.0, 0.0}, t);
}

int main() {
  chicane::solver::Trajectory<4, 1, 50> t;
  const auto plain = swing_up<PlainCartPole>(t);
  const auto report = swing_up<CartPole>(t);
  for (std::size_t k = 0; k <= 50; k += 5) {
    std::printf("%4.1f s  cart %+5.2f m  pole %4.0f deg\n", CartPole::kStep * static_cast<double>(k),
                t.x[k][0], chicane::radians_to_degrees(t.x[k][1]));
  }
  std::printf("%s after %d iterations, cost %.4f; the simple form: %s, cost %.4f\n",
              to_string(report.status).data(), report.iterations, report.cost, to_string(plain.status).data(),
              plain.cost);
  const double miss = chicane::abs(t.x[50][1] - chicane::kPi);
  return usable(report.status) && usable(plain.status) && miss < 0.05 ? 0 : 1;
}
// [/solver]
