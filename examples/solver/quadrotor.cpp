// SPDX-License-Identifier: MIT
// A quadrotor in the plane flies past a round obstacle in its way, and stops behind it. It starts from
// hovering: the first guess is the thrust that carries it. With the name of a file: writes the motion there.
#include <cstdio>
#include <memory>
#include <tuple>

#include "chicane/solver/ocp_solver.hpp"

namespace solver = chicane::solver;

struct Quadrotor {
  static constexpr int kNx = 6, kNu = 2, kNr = 8, kNe = 6, kNc = 2;
  static constexpr double kStep = 0.05, kGravity = 9.81, kArm = 0.2, kMass = 1.0, kInertia = 0.02;
  static constexpr double kGoalX = 4.0, kGoalZ = 1.0, kObstacleX = 2.0, kObstacleZ = 0.4, kRadius = 0.6;
  static constexpr double kHover = 0.5 * kMass * kGravity;

  template <class K, class X, class U>  // x = (position [m], pitch [rad], and their rates); u = thrusts [N]
  auto dynamics(K, const X& x, const U& u) const {
    const auto& [px, pz, pitch, vx, vz, rate] = x;
    const auto& [left, right] = u;
    const auto lift = (left + right) / kMass;
    const auto wx = vx + kStep * (lift * sin(pitch));
    const auto wz = vz + kStep * (lift * cos(pitch) - kGravity);
    const auto w = rate + (kStep * kArm / kInertia) * (left - right);
    return std::make_tuple(px + kStep * wx, pz + kStep * wz, pitch + kStep * w, wx, wz, w);
  }
  template <class K, class X, class U>
  auto residual(K, const X& x, const U& u) const {
    const auto& [px, pz, pitch, vx, vz, rate] = x;
    const auto& [left, right] = u;
    return std::make_tuple(0.3 * (px - kGoalX), 0.3 * (pz - kGoalZ), 0.1 * pitch, 0.1 * vx, 0.1 * vz,
                           0.1 * rate, 0.1 * (left - kHover), 0.1 * (right - kHover));
  }
  template <class X>
  auto terminal_residual(const X& x) const {
    const auto& [px, pz, pitch, vx, vz, rate] = x;
    return std::make_tuple(10.0 * (px - kGoalX), 10.0 * (pz - kGoalZ), 5.0 * pitch, 5.0 * vx, 5.0 * vz,
                           2.0 * rate);
  }
  template <class K, class X, class U>
  auto constraint(K, const X& x, const U&) const {  // outside the obstacle, above the ground
    const auto& [px, pz, pitch, vx, vz, rate] = x;
    return std::make_tuple(pow(kRadius, 2) - pow(px - kObstacleX, 2) - pow(pz - kObstacleZ, 2), -1.0 - pz);
  }
  solver::SoftPenalty soft_penalty(int) const { return {.linear = 200.0, .quadratic = 100.0}; }
  std::array<double, 2> input_lower(int) const { return {0.0, 0.0}; }
  std::array<double, 2> input_upper(int) const { return {10.0, 10.0}; }
};

int main(int argc, char** argv) {
  constexpr int kHorizon = 50;
  constexpr double kOptimum = 12.61386;  // Ipopt's, from the same guess
  const auto ocp = std::make_unique<solver::OcpSolver<Quadrotor, kHorizon>>();
  solver::Trajectory<6, 2, kHorizon> plan{.horizon = kHorizon};
  plan.u.fill({Quadrotor::kHover, Quadrotor::kHover});
  const solver::SolveReport report = ocp->solve(Quadrotor{}, {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, plan);
  std::printf("%s after %d iterations, cost %.7g\n", to_string(report.status).data(), report.iterations,
              report.cost);
  if (argc > 1) {
    std::FILE* file = std::fopen(argv[1], "w");
    for (const auto& [px, pz, pitch, vx, vz, rate] : plan.x) std::fprintf(file, "%g %g %g\n", px, pz, pitch);
    std::fclose(file);
  }
  const bool is_known = chicane::abs(report.cost - kOptimum) < 1e-5 * kOptimum;
  return report.status == solver::SolveStatus::kOptimal && is_known ? 0 : 1;
}
