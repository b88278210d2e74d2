// SPDX-License-Identifier: MIT
// A rocket comes down from 500 m and lands upright on its engine, which can neither be shut off nor swivel
// far, and burns the mass it carries. The first guess is a straight line of states to the pad. With the name
// of a file: writes the motion there.
#include <cstdio>
#include <memory>
#include <tuple>

#include "chicane/solver/ocp_solver.hpp"

namespace solver = chicane::solver;

struct Rocket {
  static constexpr int kNx = 7, kNu = 2, kNr = 6, kNe = 0, kNeh = 6, kNc = 2;
  static constexpr double kStep = 0.25, kGravity = 9.81, kLever = 8.0, kFlow = 0.00035, kMass = 25.0;
  static constexpr double kMost = 2.0 * kMass * kGravity, kLeast = 0.4 * kMost, kGlide = 0.4;

  // x = (position [m], speeds [m/s], pitch [rad], its rate [rad/s], mass [t]); u = (thrust [kN], swivel
  // [rad])
  template <class K, class X, class U>
  auto dynamics(K, const X& x, const U& u) const {
    const auto& [px, pz, vx, vz, pitch, rate, mass] = x;
    const auto& [thrust, swivel] = u;
    const auto push = thrust / mass;
    const auto wx = vx + kStep * (push * sin(pitch + swivel));
    const auto wz = vz + kStep * (push * cos(pitch + swivel) - kGravity);
    const auto w = rate - kStep * (kLever * push * sin(swivel) / 120.0);
    return std::make_tuple(px + kStep * wx, pz + kStep * wz, wx, wz, pitch + kStep * w, w,
                           mass - kStep * kFlow * thrust);
  }
  template <class K, class X, class U>
  auto residual(K, const X& x, const U& u) const {
    const auto& [px, pz, vx, vz, pitch, rate, mass] = x;
    const auto& [thrust, swivel] = u;
    return std::make_tuple(0.02 * px, 0.02 * vx, pitch, rate, 0.003 * thrust, 2.0 * swivel);
  }
  template <class X>
  auto terminal_residual(const X&) const {
    return std::make_tuple();
  }
  template <class X>
  auto terminal_equality(const X& x) const {  // = 0: it stands on the pad
    const auto& [px, pz, vx, vz, pitch, rate, mass] = x;
    return std::make_tuple(px, pz, vx, vz, pitch, rate);
  }
  template <class K, class X, class U>
  auto constraint(K, const X& x, const U&) const {  // inside a cone above the pad
    const auto& [px, pz, vx, vz, pitch, rate, mass] = x;
    return std::make_tuple(kGlide * px - pz - 1.0, -kGlide * px - pz - 1.0);
  }
  bool is_hard(int) const { return true; }
  solver::SoftPenalty soft_penalty(int) const { return {.linear = 10.0, .quadratic = 10.0}; }
  std::array<double, 2> input_lower(int) const { return {kLeast, -0.2}; }
  std::array<double, 2> input_upper(int) const { return {kMost, 0.2}; }
};

int main(int argc, char** argv) {
  constexpr int kHorizon = 60;
  constexpr double kOptimum = 65.07647;  // Ipopt's, from the same guess
  constexpr std::array<double, 7> kStart{120.0, 500.0, -15.0, -60.0, 0.05, 0.0, Rocket::kMass};
  constexpr std::array<double, 7> kGoal{0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.95 * Rocket::kMass};
  const auto ocp =
      std::make_unique<solver::OcpSolver<Rocket, kHorizon>>(solver::SolverOptions{.start_from_states = true});
  solver::Trajectory<7, 2, kHorizon> plan{.horizon = kHorizon};
  plan.u.fill({Rocket::kMass * Rocket::kGravity, 0.0});
  for (std::size_t k = 0; k <= kHorizon; ++k) {
    for (std::size_t i = 0; i < 7; ++i)
      plan.x[k][i] = kStart[i] + static_cast<double>(k) / kHorizon * (kGoal[i] - kStart[i]);
  }
  const auto report = ocp->solve(Rocket{}, kStart, plan);
  std::printf("%s after %d iterations, cost %.7g, what must hold is missed by %.1e\n",
              to_string(report.status).data(), report.iterations, report.cost, report.miss);
  if (argc > 1) {
    std::FILE* file = std::fopen(argv[1], "w");
    for (std::size_t k = 0; k <= kHorizon; ++k) {
      const auto& u = plan.u[k < kHorizon ? k : kHorizon - 1];
      std::fprintf(file, "%g %g %g %g %g\n", plan.x[k][0], plan.x[k][1], plan.x[k][4], u[0] / Rocket::kMost,
                   u[1]);
    }
    std::fclose(file);
  }
  const bool is_known = chicane::abs(report.cost - kOptimum) < 1e-5 * kOptimum;
  return report.status == solver::SolveStatus::kOptimal && is_known ? 0 : 1;
}
