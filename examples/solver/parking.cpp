// SPDX-License-Identifier: MIT
// A cart with steering is parked between two pillars, with turns back and forth. The first guess is to stand
// still. With the name of a file: writes the motion there.
#include <cstdio>
#include <memory>
#include <tuple>

#include "chicane/solver/ocp_solver.hpp"

namespace solver = chicane::solver;

struct Parking {
  static constexpr int kNx = 5, kNu = 2, kNr = 6, kNe = 5, kNc = 4;
  static constexpr double kStep = 0.15, kBase = 2.0, kMostSteering = 0.6, kRadius = 1.0;
  static constexpr double kPillarX = -1.5, kPillarY = 1.5;  // the other one on the other side of y = 0

  // x = (position [m], heading [rad], speed [m/s], steering [rad]); u = (acceleration [m/s²], steering rate
  // [rad/s])
  template <class K, class X, class U>
  auto dynamics(K, const X& x, const U& u) const {
    const auto& [px, py, heading, speed, steering] = x;
    const auto& [push, turn] = u;
    return std::make_tuple(px + kStep * (speed * cos(heading)), py + kStep * (speed * sin(heading)),
                           heading + kStep / kBase * (speed * tan(steering)), speed + kStep * push,
                           steering + kStep * turn);
  }
  template <class K, class X, class U>
  auto residual(K, const X& x, const U& u) const {
    const auto& [px, py, heading, speed, steering] = x;
    const auto& [push, turn] = u;
    return std::make_tuple(0.05 * px, 0.05 * py, 0.05 * heading, 0.1 * speed, 0.2 * push, 0.2 * turn);
  }
  template <class X>
  auto terminal_residual(const X& x) const {
    const auto& [px, py, heading, speed, steering] = x;
    return std::make_tuple(10.0 * px, 10.0 * py, 10.0 * heading, 5.0 * speed, steering);
  }
  template <class K, class X, class U>
  auto constraint(K, const X& x, const U&) const {
    const auto& [px, py, heading, speed, steering] = x;
    const auto beside = pow(kRadius, 2) - pow(px - kPillarX, 2);
    return std::make_tuple(beside - pow(py - kPillarY, 2), beside - pow(py + kPillarY, 2),
                           steering - kMostSteering, -kMostSteering - steering);
  }
  solver::SoftPenalty soft_penalty(int) const { return {.linear = 50.0, .quadratic = 50.0}; }
  std::array<double, 2> input_lower(int) const { return {-2.0, -1.0}; }
  std::array<double, 2> input_upper(int) const { return {2.0, 1.0}; }
};

int main(int argc, char** argv) {
  constexpr int kHorizon = 60;
  constexpr double kOptimum = 2.49587;  // Ipopt's, from this answer; from the guess it gets to 34.9
  const auto ocp = std::make_unique<solver::OcpSolver<Parking, kHorizon>>();
  solver::Trajectory<5, 2, kHorizon> plan{.horizon = kHorizon};
  const solver::SolveReport report = ocp->solve(Parking{}, {-1.0, 4.0, 0.0, 0.0, 0.0}, plan);
  std::printf("%s after %d iterations, cost %.7g\n", to_string(report.status).data(), report.iterations,
              report.cost);
  if (argc > 1) {
    std::FILE* file = std::fopen(argv[1], "w");
    for (const auto& [px, py, heading, speed, steering] : plan.x)
      std::fprintf(file, "%g %g %g %g\n", px, py, heading, steering);
    std::fclose(file);
  }
  const bool is_known = chicane::abs(report.cost - kOptimum) < 1e-5 * kOptimum;
  return report.status == solver::SolveStatus::kOptimal && is_known ? 0 : 1;
}
