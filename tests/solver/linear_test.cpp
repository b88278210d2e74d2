// SPDX-License-Identifier: MIT

#include "chicane/solver/detail/small_qp.hpp"
#include "chicane/solver/ocp_solver.hpp"
#include "problems/optimality.hpp"
#include "support/chicane_test.hpp"
#include "support/linear_problem.hpp"

namespace chicane {
namespace {

TEST(SmallQp, EqualsCoordinateDescentOnAThousandRandomBoxes) {
  Random random{11};
  for (int i = 0; i < 1000; ++i) {
    solver::SmallQp<3> qp;
    Eigen::Matrix3d root;
    for (int j = 0; j < 9; ++j) root(j) = random.uniform(-1.0, 1.0);
    const Eigen::MatrixXd H = root * root.transpose() + 0.05 * Eigen::Matrix3d::Identity();
    Eigen::VectorXd g(3);
    Eigen::VectorXd low(3);
    Eigen::VectorXd high(3);
    for (int j = 0; j < 3; ++j) {
      qp.g[j] = g(j) = random.uniform(-2.0, 2.0);
      qp.low[j] = low(j) = random.uniform(-1.5, 0.5);
      qp.high[j] = high(j) = low(j) + (j == i % 7 ? 0.0 : random.uniform(0.0, 2.0));
      for (int l = 0; l < 3; ++l) qp.H[j][l] = H(j, l);
    }
    EXPECT_EQ(qp.make_positive(), 0.0);
    qp.solve();
    const Eigen::VectorXd expected = test::solve_dense_qp(H, g, low, high);
    for (int j = 0; j < 3; ++j) ASSERT_NEAR(qp.u[j], expected(j), 1e-9) << "box " << i << ", input " << j;
  }
}

TEST(SmallQp, ShiftsAnIndefiniteBlockUntilItIsPositive) {
  solver::SmallQp<2> qp{
      .H = {{1.0, 3.0}, {3.0, 1.0}}, .g = {1.0, 0.0}, .low = {-1e9, -1e9}, .high = {1e9, 1e9}};
  EXPECT_GT(qp.make_positive(), 2.0);  // the smallest eigenvalue is -2
  EXPECT_GT(qp.H[0][0] * qp.H[1][1], qp.H[0][1] * qp.H[1][0]);
}

template <int Nx, int Nu>
void compare_with_dense(std::uint64_t seed, int count) {
  using Problem = test::LinearProblem<Nx, Nu>;
  Random random{seed};
  const auto ocp = std::make_unique<solver::OcpSolver<Problem, Problem::kStages>>();
  for (int i = 0; i < count; ++i) {
    const Problem problem = test::random_linear_problem<Nx, Nu>(random);
    std::array<double, Nx> x0;
    for (double& value : x0) value = random.uniform(-2.0, 2.0);
    solver::Trajectory<Nx, Nu, Problem::kStages> trajectory;
    trajectory.horizon = 1 + i % Problem::kStages;
    const auto report = ocp->solve(problem, x0, trajectory);
    ASSERT_EQ(report.status, solver::SolveStatus::kOptimal) << "problem " << i;
    EXPECT_TRUE(bench::inputs_are_inside(problem, trajectory));
    const Eigen::VectorXd expected = test::solve_densely(problem, x0, trajectory.horizon);
    for (int k = 0; k < trajectory.horizon; ++k) {
      for (int m = 0; m < Nu; ++m) {
        // The solver stops at a slope of 1e-6; curvatures are at least about 0.1.
        ASSERT_NEAR(trajectory.u[k][m], expected(k * Nu + m), 1e-5) << "problem " << i << ", stage " << k;
      }
    }
  }
}

TEST(OcpSolver, EqualsADenseReferenceOnLinearProblemsWithOneInput) { compare_with_dense<2, 1>(21, 300); }
TEST(OcpSolver, EqualsADenseReferenceOnLinearProblemsWithTwoInputs) { compare_with_dense<3, 2>(22, 300); }
TEST(OcpSolver, EqualsADenseReferenceOnLinearProblemsWithMoreInputsThanStates) {
  compare_with_dense<2, 4>(23, 200);
}
#ifdef CHICANE_SLOW_TESTS
TEST(OcpSolver, EqualsADenseReferenceOnLinearProblemsWithManyStates) { compare_with_dense<12, 3>(24, 30); }
#endif

TEST(OcpSolver, SolvesAnUnboundedLinearProblemInOneTurnAndOneSweep) {
  using Problem = test::LinearProblem<3, 2>;
  Random random{31};
  Problem problem = test::random_linear_problem<3, 2>(random);
  for (auto& bound : problem.low) bound.fill(-std::numeric_limits<double>::infinity());
  for (auto& bound : problem.high) bound.fill(std::numeric_limits<double>::infinity());
  solver::OcpSolver<Problem, 16> ocp;
  solver::Trajectory<3, 2, 16> trajectory;
  trajectory.horizon = 16;
  const auto report = ocp.solve(problem, {1.0, -1.0, 0.5}, trajectory);
  EXPECT_EQ(report.status, solver::SolveStatus::kOptimal);
  EXPECT_EQ(report.iterations, 1);
  EXPECT_EQ(report.sweeps, 1);
  EXPECT_LT(bench::projected_gradient(problem, {1.0, -1.0, 0.5}, trajectory), 1e-10);
}

}  // namespace
}  // namespace chicane
