// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <memory>

#include "chicane/solver/ocp_solver.hpp"
#include "families/hard.hpp"
#include "families/measure_family.hpp"
#include "problems/corridor_problem.hpp"
#include "problems/described_problem.hpp"
#include "problems/optimality.hpp"
#include "problems/rate_problem.hpp"

#ifdef CHICANE_HAVE_IPOPT
#include "problems/ipopt_problem.hpp"
#endif

namespace chicane {
namespace {

using bench::DescribedProblem;
using solver::SolveStatus;

constexpr int kCapacity = 50;

#ifdef CHICANE_HAVE_IPOPT

/// Where a solve starts from: inputs of zero, those of a path-following law, or the optimum of a slightly
/// different problem.
enum class Start { kCold, kPathLaw, kWarm };

struct Family {
  Start start;
  int horizon;
  int count;
};

std::string name_of(const testing::TestParamInfo<Family>& info) {
  const char* start[] = {"Cold", "PathLaw", "Warm"};
  return std::string(start[static_cast<int>(info.param.start)]) + "N" + std::to_string(info.param.horizon);
}

template <class Problem>
void choose_start(Start start, const bench::DescribedInstance& plain, const Problem& problem,
                  solver::OcpSolver<Problem, kCapacity>& ocp,
                  bench::DescribedTrajectory<kCapacity>& trajectory) {
  const int horizon = trajectory.horizon;
  trajectory = {};
  trajectory.horizon = horizon;
  if (start != Start::kCold) bench::guess_by_path_law(plain, trajectory);
  if (start == Start::kWarm) {  // the previous cycle: half a step earlier, another speed wanted
    Problem before = problem;
    before.speed_reference -= 0.5;
    auto x0 = plain.start;
    x0[1] -= 0.05;
    x0[4] += 0.05;
    ocp.solve(before, x0, trajectory);
    solver::shift(trajectory, 0.5);
  }
  solver::roll_out(problem, plain.start, trajectory);
}

struct AgainstIpopt : testing::TestWithParam<Family> {};

TEST_P(AgainstIpopt, AgreesOnTheOptimumOfTheDescribedProblem) {
  const auto ocp = std::make_unique<solver::OcpSolver<DescribedProblem, kCapacity>>();
  Random random{1000 + static_cast<std::uint64_t>(GetParam().horizon)};
  for (int i = 0; i < GetParam().count; ++i) {
    const auto instance = bench::random_instance(random, GetParam().horizon);
    bench::DescribedTrajectory<kCapacity> own;
    own.horizon = GetParam().horizon;
    choose_start(GetParam().start, instance, instance.problem, *ocp, own);
    auto reference = own;
    const auto report = ocp->solve(instance.problem, instance.start, own);
    ASSERT_EQ(report.status, SolveStatus::kOptimal) << i;
    const double cost = bench::solve_with_ipopt(instance.problem, instance.start, reference);
    ASSERT_NEAR(report.cost, cost, 1e-6 * cost) << i;
    ASSERT_TRUE(bench::inputs_are_inside(instance.problem, own)) << i;
    // Simulated anew, with derivatives that share no code with the solver's. Its own measure is 1e-6 at most;
    // at 50 stages the accepted defects (1e-13 of the state) times Hessians near 1e5 may add as much again.
    ASSERT_LE(bench::projected_gradient(instance.problem, instance.start, own),
              own.horizon < 50 ? 1.1e-6 : 1e-5)
        << i;
  }
}

TEST_P(AgainstIpopt, AgreesOnTheOptimumWithASoftCorridor) {
  using bench::CorridorProblem;
  if (GetParam().horizon < 2) GTEST_SKIP() << "one stage: the corridor is on the given state only";
  const auto ocp = std::make_unique<solver::OcpSolver<CorridorProblem, kCapacity>>();
  Random random{2000 + static_cast<std::uint64_t>(GetParam().horizon)};
  for (int i = 0; i < GetParam().count; ++i) {
    const auto instance = bench::random_corridor(random, GetParam().horizon);
    const bench::DescribedInstance plain{.problem = static_cast<const DescribedProblem&>(instance.problem),
                                         .start = instance.start};
    bench::DescribedTrajectory<kCapacity> own;
    own.horizon = GetParam().horizon;
    choose_start(GetParam().start, plain, instance.problem, *ocp, own);
    auto reference = own;
    const auto report = ocp->solve(instance.problem, instance.start, own);
    ASSERT_EQ(report.status, SolveStatus::kOptimal) << i;
    const double cost = bench::solve_with_ipopt(instance.problem, instance.start, reference);
    ASSERT_NEAR(report.cost, cost, 1e-6 * cost) << i;
    ASSERT_LE(report.complementarity, 1e-6) << i;
    ASSERT_TRUE(bench::inputs_are_inside(instance.problem, own)) << i;
  }
}

/// Slope of the simulated cost at the inputs `from` on the straight line to `to`.
double slope_towards(const bench::RateInstance& instance, const bench::DescribedTrajectory<kCapacity>& from,
                     const bench::DescribedTrajectory<kCapacity>& to) {
  const auto gradient = bench::simulated_gradient(instance.problem, instance.start, from);
  double slope = 0.0;
  for (std::size_t k = 0; k < gradient.size(); ++k) {
    for (std::size_t m = 0; m < gradient[k].size(); ++m)
      slope += gradient[k][m] * (to.u[k][m] - from.u[k][m]);
  }
  return slope;
}

TEST_P(AgainstIpopt, AgreesOnTheOptimumWithBoundsOnChanges) {
  using bench::RateProblem;
  const auto ocp = std::make_unique<solver::OcpSolver<RateProblem, kCapacity>>(
      solver::SolverOptions{.max_iterations = 100});
  Random random{3000 + static_cast<std::uint64_t>(GetParam().horizon)};
  int others = 0;
  for (int i = 0; i < GetParam().count; ++i) {
    const auto instance = bench::random_rates(random, GetParam().horizon);
    const bench::DescribedInstance plain{.problem = static_cast<const DescribedProblem&>(instance.problem),
                                         .start = instance.start};
    bench::DescribedTrajectory<kCapacity> own;
    own.horizon = GetParam().horizon;
    choose_start(GetParam().start, plain, instance.problem, *ocp, own);
    auto reference = own;
    const auto report = ocp->solve(instance.problem, instance.start, own);
    ASSERT_EQ(report.status, SolveStatus::kOptimal) << i;
    const double cost = bench::solve_with_ipopt(instance.problem, instance.start, reference);
    ASSERT_TRUE(bench::inputs_are_inside(instance.problem, own)) << i;
    if (std::fabs(report.cost - cost) <= 1e-6 * cost) continue;
    ++others;  // two local optima: between them lie admissible inputs only, and the cost rises from both ends
    ASSERT_GE(slope_towards(instance, own, reference), 0.0) << i << ": " << report.cost << " and " << cost;
    ASSERT_GE(slope_towards(instance, reference, own), 0.0) << i << ": " << report.cost << " and " << cost;
  }
  EXPECT_LE(others, 1);
}

constexpr Family kFamilies[] = {
    {Start::kCold, 1, 20},    {Start::kCold, 2, 30},     {Start::kCold, 7, 40},     {Start::kCold, 10, 40},
    {Start::kCold, 20, 40},   {Start::kCold, 50, 20},    {Start::kPathLaw, 1, 20},  {Start::kPathLaw, 2, 30},
    {Start::kPathLaw, 7, 40}, {Start::kPathLaw, 10, 40}, {Start::kPathLaw, 20, 40}, {Start::kPathLaw, 50, 20},
    {Start::kWarm, 1, 20},    {Start::kWarm, 2, 30},     {Start::kWarm, 7, 40},     {Start::kWarm, 10, 40},
    {Start::kWarm, 20, 40},   {Start::kWarm, 50, 20}};
INSTANTIATE_TEST_SUITE_P(OcpSolver, AgainstIpopt, testing::ValuesIn(kFamilies), name_of);

/// Ipopt from the answer: its optimum there has the same cost.
template <class P>
void expect_hard_optima(bench::NaiveStart start, int count) {
  using Measurement = bench::FamilyMeasurement<P>;
  const auto ocp = std::make_unique<solver::OcpSolver<P, P::kHorizon>>(
      solver::SolverOptions{.tolerance = 1e-8, .start_from_states = start == bench::NaiveStart::kLine});
  for (int seed = 0; seed < count; ++seed) {
    const auto instance = Measurement::instance(seed);
    const auto own = std::make_unique<typename Measurement::Trajectory>(Measurement::guess(instance, start));
    const auto report = ocp->solve(instance.problem, instance.start, *own);
    ASSERT_EQ(report.status, SolveStatus::kOptimal) << seed;
    const bench::OverArrays<P> arrays{instance.problem};
    const double cost = bench::solve_with_ipopt(arrays, instance.start, *own);
    ASSERT_NEAR(report.cost, cost, 1e-6 * std::fabs(cost)) << seed;
  }
}
TEST(HardAgainstIpopt, AgreesWhereAPoleMustStand) {
  expect_hard_optima<bench::HardCartPole>(bench::NaiveStart::kIdle, 6);
}
TEST(HardAgainstIpopt, AgreesWhereARocketMustStandOnItsPad) {
  expect_hard_optima<bench::HardRocketLanding>(bench::NaiveStart::kLine, 6);
}

#else

TEST(AgainstIpopt, IsSkipped) { GTEST_SKIP() << "built without Ipopt (Debian: coinor-libipopt-dev)"; }

#endif

}  // namespace
}  // namespace chicane
