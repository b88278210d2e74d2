// SPDX-License-Identifier: MIT
// Optima beside Ipopt's. ipopt_constraints_test.cpp has problems with more constraints, among the slow tests.

#include "chicane/solver/ocp_solver.hpp"
#include "problems/described_problem.hpp"
#include "problems/optimality.hpp"
#include "solver/ipopt_families.hpp"

#ifdef CHICANE_HAVE_IPOPT
#include "problems/ipopt_problem.hpp"
#include "support/chicane_test.hpp"
#endif

namespace chicane {
namespace {

#ifdef CHICANE_HAVE_IPOPT

using bench::DescribedProblem;
using solver::SolveStatus;
using namespace test;

struct AgainstIpopt : testing::TestWithParam<Family> {};

TEST_P(AgainstIpopt, AgreesOnTheOptimumOfTheDescribedProblem) {
  const auto ocp = std::make_unique<solver::OcpSolver<DescribedProblem, kIpoptCapacity>>();
  Random random{1000 + static_cast<std::uint64_t>(GetParam().horizon)};
  for (int i = 0; i < GetParam().count; ++i) {
    const auto instance = bench::random_instance(random, GetParam().horizon);
    bench::DescribedTrajectory<kIpoptCapacity> own;
    own.horizon = GetParam().horizon;
    choose_start(GetParam().start, instance, *ocp, own);
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

INSTANTIATE_TEST_SUITE_P(OcpSolver, AgainstIpopt, testing::ValuesIn(kFamilies), name_of);

#else

TEST(AgainstIpopt, IsSkipped) { GTEST_SKIP() << "built without Ipopt (Debian: coinor-libipopt-dev)"; }

#endif

}  // namespace
}  // namespace chicane
