// SPDX-License-Identifier: MIT
#include "families/impossible.hpp"

#include "chicane/solver/ocp_solver.hpp"
#include "families/measure_family.hpp"
#include "support/chicane_test.hpp"

namespace chicane::bench {
namespace {

using solver::HardReport;
using solver::SolveStatus;

/// How the instances of one kind end, from idle inputs and from a line of states.
struct Endings {
  int solves = 0, infeasible = 0, optimal = 0, usable = 0, most_iterations = 0;
};
template <class P, class Draw>
Endings solve(int instances, const Draw& draw) {
  Endings endings;
  const auto ocp = std::make_unique<solver::OcpSolver<P, P::kHorizon>>();
  for (const NaiveStart start : {NaiveStart::kIdle, NaiveStart::kLine}) {
    ocp->set_options({.start_from_states = start == NaiveStart::kLine});
    for (int seed = 0; seed < instances; ++seed) {
      Random random{static_cast<std::uint64_t>(seed) * 7919U + 17U};
      P one;
      draw(one, random);
      auto t = FamilyMeasurement<P>::guess(one, start);
      const HardReport report = ocp->solve(one, one.start, t);
      ++endings.solves;
      endings.infeasible += report.status == SolveStatus::kInfeasible ? 1 : 0;
      endings.optimal += report.status == SolveStatus::kOptimal ? 1 : 0;
      endings.usable += usable(report.status) ? 1 : 0;
      endings.most_iterations = std::max(endings.most_iterations, report.iterations);
    }
  }
  return endings;
}

// Near misses need a certificate within rounding, conflicts one without a nearly feasible point.
TEST(Impossible, PointMassesAreInfeasibleWhateverTheConflict) {
  for (int kind = 0; kind < PointMass::kKinds; ++kind) {
    const Endings endings = solve<PointMass>(5, [&](PointMass& one, Random& random) {
      one.draw(static_cast<PointMass::Kind>(kind), random, true);
    });
    EXPECT_EQ(endings.usable, 0) << kind;
    EXPECT_EQ(endings.infeasible, endings.solves) << kind;
    EXPECT_LE(endings.most_iterations, 600) << kind;
  }
}
TEST(Impossible, MultipliersOfTheViolationStartNoOtherSolve) {
  using Solver = solver::OcpSolver<PointMass, PointMass::kHorizon>;
  const auto ocp = std::make_unique<Solver>();
  Random random{17U};
  PointMass one;
  one.draw(PointMass::Kind{}, random, true);
  auto t = FamilyMeasurement<PointMass>::guess(one, NaiveStart::kIdle);
  const auto multipliers = std::make_unique<Solver::Multipliers>();
  EXPECT_EQ(ocp->solve(one, one.start, t, *multipliers).status, SolveStatus::kInfeasible);
  EXPECT_FALSE(multipliers->is_known);
}
TEST(Impossible, PointMassesWithSomeRoomAreOptimal) {
  for (int kind = 0; kind < PointMass::kKinds; ++kind) {
    const Endings endings = solve<PointMass>(2, [&](PointMass& one, Random& random) {
      one.draw(static_cast<PointMass::Kind>(kind), random, false);
    });
    EXPECT_EQ(endings.optimal, endings.solves) << kind;
  }
}

template <class P>
void expect_infeasible() {
  const Endings endings = solve<P>(8, [](P& one, Random& random) { one.draw(random, true); });
  EXPECT_EQ(endings.usable, 0);
  EXPECT_EQ(endings.infeasible, endings.solves);
  EXPECT_LE(endings.most_iterations, 800);  // rounds from the guess come after the proof
}
TEST(Impossible, ChainsTooShortForTheirPeakAreInfeasible) { expect_infeasible<HangingChain>(); }
TEST(Impossible, CartsThatTurnTooSlowlyAreInfeasible) { expect_infeasible<SlowTurn>(); }

// Steps from a symmetric guess stay on the line through the middle of the post.
TEST(Impossible, APostDeadAheadIsPassed) {
  const auto ocp = std::make_unique<solver::OcpSolver<PointMass, PointMass::kHorizon>>();
  for (const NaiveStart start : {NaiveStart::kIdle, NaiveStart::kLine}) {
    ocp->set_options({.start_from_states = start == NaiveStart::kLine});
    for (const double radius : {0.1, 0.2, 0.3}) {
      PointMass one;
      one.radius = radius;
      one.post_x = 0.8;
      one.end = one.goal = {1.6, 0.0, 0.0, 0.0};
      one.has_end = {1.0, 1.0, 1.0, 1.0};
      auto t = FamilyMeasurement<PointMass>::guess(one, start);
      EXPECT_EQ(ocp->solve(one, one.start, t).status, SolveStatus::kOptimal) << radius << to_string(start);
    }
  }
}

}  // namespace
}  // namespace chicane::bench
