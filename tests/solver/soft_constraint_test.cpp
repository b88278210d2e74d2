// SPDX-License-Identifier: MIT
#include "chicane/solver/detail/soft_constraint.hpp"

#include "chicane/solver/ocp_solver.hpp"
#include "problems/described_problem.hpp"
#include "problems/optimality.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

using bench::CorridorProblem;
using solver::SoftConstraint;
using solver::SoftPenalty;
using solver::SolveStatus;

/// Powers of ten between two exponents.
double decade(Random& random, double low, double high) { return std::pow(10.0, random.uniform(low, high)); }

TEST(SoftConstraint, CentreSolvesTheCentralPathForAnyPenaltyAndValue) {
  Random random{41};
  for (int i = 0; i < 5000; ++i) {
    const SoftPenalty penalty{.linear = i % 10 == 0 ? 0.0 : decade(random, -2.0, 5.0),
                              .quadratic = decade(random, -2.0, 5.0)};
    const double mu = decade(random, -8.0, 3.0);
    SoftConstraint<> c;
    c.value = (i % 2 == 0 ? 1.0 : -1.0) * decade(random, -6.0, 3.0);
    c.centre(penalty, mu);
    ASSERT_GT(c.s, 0.0);
    ASSERT_GT(c.t, 0.0);
    ASSERT_NEAR(c.s - c.t, c.value, 1e-12 * (c.s + c.t));
    const double pull = penalty.linear + penalty.quadratic * c.s;
    ASSERT_NEAR(c.n + c.z, pull, 1e-6 * pull) << "value " << c.value << ", mu " << mu;
  }
}

TEST(SoftConstraint, ModelPredictsTheMultiplierAfterTheStep) {
  Random random{42};
  const SoftPenalty penalty{.linear = 500.0, .quadratic = 100.0};
  for (int i = 0; i < 1000; ++i) {
    SoftConstraint<> c;
    c.value = random.uniform(-2.0, 2.0);
    c.s = decade(random, -3.0, 1.0);
    c.t = decade(random, -3.0, 1.0);
    c.n = decade(random, -1.0, 3.0);
    c.z = decade(random, -1.0, 3.0);
    const double change = random.uniform(-0.5, 0.5);
    const SoftConstraint<> step = c.step(penalty, 0.1, change);
    const SoftConstraint<>::Model model = c.model(penalty, 0.1);
    const double predicted = model.slope + model.curvature * change;
    ASSERT_NEAR(c.z + step.z, predicted, 1e-9 * (std::fabs(predicted) + model.curvature + c.z)) << i;
    ASSERT_GE(model.curvature, 0.0);
  }
}

TEST(SoftConstraint, SmoothedPenaltyTendsToTheExactOne) {
  const SoftPenalty penalty{.linear = 500.0, .quadratic = 100.0};
  for (const double value : {-1.0, -1e-3, 1e-3, 1.0}) {
    SoftConstraint<> c;
    c.value = value;
    c.centre(penalty, 1e-9);
    EXPECT_NEAR(c.barrier(penalty, 1e-9), c.penalty(penalty), 1e-6);
  }
}

struct SoftOcp : testing::Test {
  static constexpr int kHorizon = 20;
  using Solver = solver::OcpSolver<CorridorProblem, 60>;
  std::unique_ptr<Solver> ocp = std::make_unique<Solver>();
  bench::DescribedTrajectory<60> trajectory;
  CorridorProblem problem;
  std::array<double, 8> start{};

  SoftOcp() {
    trajectory.horizon = kHorizon;
    problem.path = {0.3, 0.05, 0.0, 0.0};
    problem.speed_reference = 12.0;
    bench::DescribedInstance plain{.problem = static_cast<const bench::DescribedProblem&>(problem)};
    plain.place(12.0);
    start = plain.start;
  }
  solver::SolveReport solve() { return ocp->solve(problem, start, trajectory); }
};

TEST_F(SoftOcp, ACorridorThatIsWideEnoughChangesNothing) {
  problem.half_width = 50.0;
  problem.window_end = 0;
  ASSERT_EQ(solve().status, SolveStatus::kOptimal);
  EXPECT_LE(bench::projected_gradient<bench::DescribedProblem>(problem, start, trajectory), 1e-5);
}

TEST_F(SoftOcp, AWindowIsPassedWithoutViolationWhenThatIsPossible) {
  problem.window_begin = 12;
  problem.window_end = 16;
  const auto report = solve();
  ASSERT_EQ(report.status, SolveStatus::kOptimal);
  EXPECT_LT(report.violation, 1e-5);  // the linear penalty exceeds the multiplier: an exact penalty
  for (int k = 12; k < 16; ++k) EXPECT_GT(trajectory.x[k][4], problem.keep_out - 1e-5);
}

TEST_F(SoftOcp, ReportsTheWorstStageAndConstraintWhenACapIsExceeded) {
  problem.window_begin = 2;  // 0.2 s to move 0.3 m aside and farther: too soon
  problem.window_end = 6;
  problem.keep_out = 1.0;
  problem.penalty.cap = 0.1;
  const auto report = solve();
  EXPECT_EQ(report.status, SolveStatus::kInfeasible);
  EXPECT_GT(report.violation, 0.1);
  ASSERT_EQ(report.worst_constraint, 1);  // too low
  ASSERT_GE(report.worst_stage, 2);
  ASSERT_LT(report.worst_stage, 6);
  EXPECT_NEAR(1.0 - trajectory.x[report.worst_stage][4], report.violation, 1e-12);
  problem.penalty.cap = 10.0;
  EXPECT_EQ(solve().status, SolveStatus::kOptimal);
}

/// Iterations run out at any moment, after steps that were in vain too: what is told is of what is returned.
TEST_F(SoftOcp, WhateverTheStatusTheReportIsOfTheAnswer) {
  Random random{81};
  int cut_short = 0;
  for (int i = 0; i < 40; ++i) {
    auto instance = bench::random_instance<bench::CorridorProblem>(random, kHorizon);
    instance.problem.penalty = {.linear = 3e4, .quadratic = 1e4};
    for (int iterations = 1; iterations <= 40; ++iterations) {
      *ocp = Solver{{.max_iterations = iterations}};
      trajectory = {};
      trajectory.horizon = kHorizon;
      Random guess{static_cast<std::uint64_t>(i) + 5};
      for (auto& u : trajectory.u) u = {guess.uniform(-0.43, 0.43), guess.uniform(-1.0, 1.0)};
      const auto report = ocp->solve(instance.problem, instance.start, trajectory);
      if (report.status != SolveStatus::kOptimal) ++cut_short;
      double worst = 0.0;
      int stage = -1;
      int constraint = -1;
      for (int k = 0; k < kHorizon; ++k) {
        const auto values = instance.problem.constraint(k, trajectory.x[k], trajectory.u[k]);
        for (int c = 0; c < 2; ++c) {
          if (!(values[static_cast<std::size_t>(c)] > worst)) continue;
          worst = values[static_cast<std::size_t>(c)];
          stage = k;
          constraint = c;
        }
      }
      ASSERT_EQ(report.worst_stage, stage) << i << ", " << iterations << " iterations";
      ASSERT_EQ(report.worst_constraint, constraint) << i << ", " << iterations << " iterations";
      ASSERT_NEAR(report.violation, worst, 1e-12) << i << ", " << iterations << " iterations";
    }
  }
  EXPECT_GT(cut_short, 400);
}

/// A unit more room saves the marginal penalty of the violation, and nothing where there is room.
TEST_F(SoftOcp, KnowsTheMultiplierOfAConstraint) {
  problem.window_begin = 2;
  problem.window_end = 6;
  problem.keep_out = 1.0;
  *ocp = Solver{{.tolerance = 1e-9}};
  ASSERT_EQ(solve().status, SolveStatus::kOptimal);
  int violated = 0;
  for (int k = 0; k < kHorizon; ++k) {
    const auto values = problem.constraint(k, trajectory.x[k], trajectory.u[k]);
    for (int c = 0; c < 2; ++c) {
      const double value = values[static_cast<std::size_t>(c)];
      if (value > 1e-3) {
        const double penalty = problem.penalty.linear + problem.penalty.quadratic * value;
        EXPECT_NEAR(ocp->constraint_multiplier(k, c), penalty, 1e-3) << k;
        ++violated;
      } else if (value < -1e-3) {
        EXPECT_NEAR(ocp->constraint_multiplier(k, c), 0.0, 1e-4) << k;
      }
    }
  }
  EXPECT_GT(violated, 1);
}

TEST_F(SoftOcp, AConstraintThatIsNotANumberIsRefused) {
  problem.half_width = std::nan("");
  EXPECT_EQ(solve().status, SolveStatus::kNotFinite);
  problem.half_width = 1.2;
  EXPECT_EQ(solve().status, SolveStatus::kOptimal);
}

}  // namespace
}  // namespace chicane
