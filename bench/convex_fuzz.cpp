// SPDX-License-Identifier: MIT
// Random convex problems, possible, nearly possible and impossible ones: a linear program (GLPK) says which
// they are. Where conditions of first order hold, by the independent check, an answer is the optimum.
//
//   chicane-convex-fuzz [COUNT [FIRST]]     COUNT problems, default 100000; FIRST: seed of the first one
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "chicane/base/random.hpp"
#include "chicane/solver/ocp_solver.hpp"
#include "fuzz/linear_program.hpp"
#include "fuzz/random_convex.hpp"

namespace chicane::bench {
namespace {

/// How many of each; `open`: their least miss lies between GLPK's precision and the tolerance.
struct Tally {
  long possible = 0, solved = 0, impossible = 0, reported = 0, open = 0, unknown = 0, untrue = 0,
       iterations = 0;
};

template <int Nx, int Nu>
void try_one(long seed, Tally& tally) {
  constexpr int kCapacity = 20;
  constexpr double kPrecision = 1e-9;  // feasibility tolerance of GLPK
  using P = RandomConvex<Nx, Nu, kCapacity>;
  using Ocp = solver::OcpSolver<P, kCapacity>;
  using Lp = LinearProgram<P, kCapacity>;
  Random random{static_cast<std::uint64_t>(seed) * 2654435761U + 11U};
  const auto chance = [&](double share) { return random.uniform() < share; };
  const int horizon = 2 + static_cast<int>(random.uniform(0.0, kCapacity - 1.0));
  typename P::Start start;
  P problem = P::make(random, start, horizon);
  if (chance(0.4)) {  // an end a little within or beyond what can be reached
    const double gap = (chance(0.5) ? 1.0 : -1.0) * std::pow(10.0, random.uniform(-5.0, 0.0));
    auto& row = problem.end[0];
    row = {};
    const auto goal = P::Row::make(random, 0.0);
    const double most = Lp(problem, start, horizon).most(goal.x);
    if (std::fabs(most) < 1e6) {
      row = goal;
      row.offset = -most - gap;
    }
  }
  Lp lp(problem, start, horizon);
  const double least = lp.least_miss(), simulated = lp.miss_of_inputs();
  constexpr std::array kTolerances{1e-6, 1e-6, 1e-4, 1e-8};
  const double tolerance = kTolerances[static_cast<std::size_t>(random.uniform(0.0, 4.0))];
  const auto ocp =
      std::make_unique<Ocp>(solver::SolverOptions{.tolerance = tolerance, .start_from_states = chance(0.5)});
  typename Lp::Trajectory t;
  t.horizon = horizon;
  for (auto& u : t.u) u.fill(chance(0.3) ? random.normal() : 0.0);
  for (auto& x : t.x) x = start;
  const solver::HardReport report = ocp->solve(problem, start, t);
  const bool is_reported = report.status == solver::SolveStatus::kInfeasible,
             is_usable = usable(report.status);
  tally.iterations += report.iterations;
  const char* wrong = nullptr;
  // GLPK rounds, too: an answer that holds shows that the problem is possible, inputs of GLPK that miss when
  // they are simulated do not.
  const KktResidual kkt = check_kkt(
      OverArrays<P>{problem}, t, [&](int k, int c) { return ocp->constraint_multiplier(k, c); }, *ocp);
  const bool holds = std::max(kkt.miss, kkt.defect) <= 1.5 * tolerance && kkt.outside <= 0.0;
  const bool is_optimal =
      kkt.stationarity <= 1.5 * tolerance + kkt.rounding && kkt.subgradient <= 2.0 * std::sqrt(tolerance);
  if (report.status == solver::SolveStatus::kOptimal && !is_optimal) wrong = "optimal, but not the least";
  if (is_usable && !holds) wrong = "usable, but misses";
  if (!(least < 1e30) || (holds && least > tolerance) || (least <= kPrecision && simulated > tolerance)) {
    ++tally.unknown;
  } else if (least > 1.01 * tolerance + kPrecision) {
    ++tally.impossible;
    tally.reported += is_reported ? 1 : 0;
    if (!is_usable && !is_reported) wrong = "(impossible, not reported)";
  } else if (least > kPrecision) {
    ++tally.open;
  } else {
    ++tally.possible;
    tally.solved += is_usable ? 1 : 0;
    if (is_reported) wrong = "infeasible, but possible";
    if (!is_usable && !is_reported) wrong = "(possible, not solved)";
  }
  if (wrong == nullptr) return;
  tally.untrue += wrong[0] == '(' ? 0 : 1;
  std::printf(
      "%d states, seed %ld: %s: %s, %d iterations, tolerance %.0e, least miss %.3g, miss %.3g, cost %.6g\n",
      Nx, seed, wrong, solver::to_string(report.status).data(), report.iterations, tolerance, least,
      report.miss, report.cost);
}

}  // namespace
}  // namespace chicane::bench

int main(int argc, char** argv) {
  using namespace chicane::bench;
  const long count = argc > 1 ? std::atol(argv[1]) : 100000, first = argc > 2 ? std::atol(argv[2]) : 0;
  Tally tally;
  for (long seed = first; seed < first + count; ++seed) {
    seed % 2 == 0 ? try_one<2, 1>(seed, tally) : try_one<4, 2>(seed, tally);
  }
  std::printf(
      "of %ld possible %ld solved; of %ld impossible %ld reported; %ld between, %ld unknown; %ld untrue; "
      "%.0f "
      "iterations\n",
      tally.possible, tally.solved, tally.impossible, tally.reported, tally.open, tally.unknown, tally.untrue,
      static_cast<double>(tally.iterations) / static_cast<double>(count));
  return tally.untrue == 0 ? 0 : 1;
}
