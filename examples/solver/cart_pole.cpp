// SPDX-License-Identifier: MIT
// A pole on a cart is swung up from hanging in 2 s, with a push of at most 20 N and 0.6 m of room to each
// side, and stands at the end. The first guess is no push at all. With the name of a file: writes the motion
// there.
#include <cstdio>
#include <memory>
#include <tuple>

#include "chicane/base/math.hpp"
#include "chicane/solver/ocp_solver.hpp"

namespace solver = chicane::solver;

struct CartPole {
  static constexpr int kNx = 4, kNu = 1, kNr = 5, kNe = 0, kNeh = 4, kNc = 2;
  static constexpr double kStep = 0.04, kCart = 1.0, kPole = 0.2, kLength = 0.5, kGravity = 9.81, kRoom = 0.6;

  template <class K, class X,
            class U>  // x = (position [m], angle from hanging [rad], and their rates); u = push [N]
  auto dynamics(K, const X& x, const U& u) const {
    const auto& [position, angle, speed, rate] = x;
    const auto& [push] = u;
    const auto s = sin(angle), c = cos(angle);
    const auto inertia = kCart + kPole * s * s;
    const auto swing = kPole * kLength * rate * rate;
    const auto v = speed + kStep * ((push + s * (swing + kPole * kGravity * c)) / inertia);
    const auto torque = push * c + swing * s * c + (kCart + kPole) * kGravity * s;
    const auto w = rate - kStep * (torque / (kLength * inertia));
    return std::make_tuple(position + kStep * v, angle + kStep * w, v, w);
  }
  template <class K, class X, class U>
  auto residual(K, const X& x, const U& u) const {
    const auto& [position, angle, speed, rate] = x;
    const auto& [push] = u;
    return std::make_tuple(position, angle - chicane::kPi, 0.1 * speed, 0.1 * rate, 0.05 * push);
  }
  template <class X>
  auto terminal_residual(const X&) const {
    return std::make_tuple();
  }
  template <class X>
  auto terminal_equality(const X& x) const {  // = 0: upright in the middle, at rest
    const auto& [position, angle, speed, rate] = x;
    return std::make_tuple(position, angle - chicane::kPi, speed, rate);
  }
  template <class K, class X, class U>
  auto constraint(K, const X& x, const U&) const {
    const auto& [position, angle, speed, rate] = x;
    return std::make_tuple(position - kRoom, -kRoom - position);
  }
  bool is_hard(int) const { return true; }
  solver::SoftPenalty soft_penalty(int) const { return {.linear = 100.0, .quadratic = 100.0}; }
  std::array<double, 1> input_lower(int) const { return {-20.0}; }
  std::array<double, 1> input_upper(int) const { return {20.0}; }
};

int main(int argc, char** argv) {
  constexpr int kHorizon = 50;
  constexpr double kOptimum = 89.58529;  // Ipopt's, from the same guess
  const auto ocp = std::make_unique<solver::OcpSolver<CartPole, kHorizon>>();
  solver::Trajectory<4, 1, kHorizon> plan{.horizon = kHorizon};
  const auto report = ocp->solve(CartPole{}, {0.0, 0.0, 0.0, 0.0}, plan);
  std::printf("%s after %d iterations, cost %.7g, what must hold is missed by %.1e\n",
              to_string(report.status).data(), report.iterations, report.cost, report.miss);
  if (argc > 1) {
    std::FILE* file = std::fopen(argv[1], "w");
    for (const auto& [position, angle, speed, rate] : plan.x) std::fprintf(file, "%g %g\n", position, angle);
    std::fclose(file);
  }
  const bool is_known = chicane::abs(report.cost - kOptimum) < 1e-5 * kOptimum;
  return report.status == solver::SolveStatus::kOptimal && is_known ? 0 : 1;
}
