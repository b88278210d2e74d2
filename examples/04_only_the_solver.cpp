// SPDX-License-Identifier: MIT
// The solver knows no car. Here it swings up a pole on a cart: 2 s in 50 steps of 40 ms, pushes of at most 12
// N, a rail of 0.6 m each way that it pays to leave. The first guess is to do nothing.

// [solver]
#include <cstdio>
#include <memory>

#include "chicane/base/angle.hpp"
#include "chicane/solver/ocp_solver.hpp"

struct CartPole {
  static constexpr int kNx = 4, kNu = 1, kNr = 5, kNe = 4, kNc = 2;
  static constexpr double kStep = 0.04, kCart = 1.0, kPole = 0.2, kLength = 0.5, kGravity = 9.81;

  template <class T>  // x = (position, angle from hanging, speed, turn rate), u = push
  std::array<T, 4> dynamics(int, const std::array<T, 4>& x, const std::array<T, 1>& u) const {
    const T s = sin(x[1]), c = cos(x[1]);
    const T inertia = kCart + kPole * s * s;
    const T a = (u[0] + kPole * s * (kLength * x[3] * x[3] + kGravity * c)) / inertia;
    const T turn = -(u[0] * c + kPole * kLength * x[3] * x[3] * s * c + (kCart + kPole) * kGravity * s) /
                   (kLength * inertia);
    const T v = x[2] + kStep * a, w = x[3] + kStep * turn;  // semi-implicit Euler
    return {x[0] + kStep * v, x[1] + kStep * w, v, w};
  }
  template <class T>
  std::array<T, 5> residual(int, const std::array<T, 4>& x, const std::array<T, 1>& u) const {
    return {x[0], x[1] - chicane::kPi, 0.1 * x[2], 0.1 * x[3], 0.05 * u[0]};
  }
  template <class T>
  std::array<T, 4> terminal_residual(const std::array<T, 4>& x) const {
    return {10.0 * x[0], 30.0 * (x[1] - chicane::kPi), 5.0 * x[2], 5.0 * x[3]};
  }
  template <class T>
  std::array<T, 2> constraint(int, const std::array<T, 4>& x, const std::array<T, 1>&) const {
    return {x[0] - 0.6, -0.6 - x[0]};
  }
  chicane::solver::SoftPenalty soft_penalty(int) const { return {.linear = 100.0, .quadratic = 100.0}; }
  std::array<double, 1> input_lower(int) const { return {-20.0}; }
  std::array<double, 1> input_upper(int) const { return {20.0}; }
};

int main() {
  namespace solver = chicane::solver;
  const auto ocp =
      std::make_unique<solver::OcpSolver<CartPole, 50>>(solver::SolverOptions{.max_iterations = 200});
  solver::Trajectory<4, 1, 50> t;
  t.horizon = 50;
  const solver::SolveReport report = ocp->solve(CartPole{}, {0.0, 0.0, 0.0, 0.0}, t);
  for (int k = 0; k <= 50; k += 5) {
    std::printf("%4.1f s  cart %+5.2f m  pole %4.0f deg\n", CartPole::kStep * k, t.x[k][0],
                chicane::radians_to_degrees(t.x[k][1]));
  }
  std::printf("%s after %d turns, cost %.4f\n", to_string(report.status).data(), report.iterations,
              report.cost);
  const double miss = chicane::abs(t.x[50][1] - chicane::kPi);
  return usable(report.status) && miss < 0.05 ? 0 : 1;
}
// [/solver]
