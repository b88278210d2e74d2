// SPDX-License-Identifier: MIT
// Random problems, most of them unpleasant; bench/solver_fuzz.cpp has more of them.

#include "chicane/base/random.hpp"
#include "chicane/solver/ocp_solver.hpp"
#include "fuzz/classify.hpp"
#include "fuzz/random_problem.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

template <class Problem>
void expect_confirmed(std::uint64_t first, std::uint64_t count, std::uint64_t least_usable) {
  using Ocp = solver::OcpSolver<Problem, 40>;
  const auto one = std::make_unique<bench::FuzzCase<Problem, 40>>();
  std::uint64_t usable = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    Random random{seed * 2654435761U + 11U};
    bench::make_case(random, *one);
    const auto ocp = std::make_unique<Ocp>(one->options);
    one->report = ocp->solve(one->problem, one->start, one->answer);
    usable += solver::usable(one->report.status) ? 1 : 0;
    const bench::Wrong wrong = bench::Judge<Problem, 40, Ocp>{*one, *ocp}.verdict();
    EXPECT_EQ(wrong, bench::Wrong::kNothing) << seed << ": " << bench::kWrongNames[static_cast<int>(wrong)];
  }
  EXPECT_GE(usable, least_usable);  // the check has something to do
}

// Of 1000 answers 15 were none: multipliers of another iterate than the one handed out, a barrier that was
// still high, inputs that cost more than the guess.
TEST(RandomProblems, GetAnswersThatAnIndependentCheckConfirms) {
  expect_confirmed<bench::RandomStructured<2, 1, 1>>(0, 400, 200);
}
// Of these two were "optimal" or "at the floor" with defects that are not finite.
TEST(RandomProblems, GetNoAnswersWithDefectsThatAreNotNumbers) {
  expect_confirmed<bench::RandomStructured<1, 1, 0>>(7420, 40, 20);
}

#ifdef CHICANE_SLOW_TESTS
// At a cost of 3e22 rounding is larger than any slope: "budget spent" was no answer that may be used.
TEST(RandomProblems, GetNoAnswersWhoseCostHasNoDigitsLeft) {
  expect_confirmed<bench::RandomStructured<4, 2, 2>>(245, 24, 12);
}

// One was "budget spent" with slacks and multipliers of another point: the filter method had begun where the
// working set cycled, at the best iterate so far.
TEST(RandomProblems, GetNoAnswersWithMultipliersOfAnotherPoint) {
  expect_confirmed<bench::RandomStructured<4, 2, 2>>(1000205, 20, 8);
}
#endif

// Of 800, 5 were "infeasible" though short steps from the answer lead to where everything holds, and of the
// stalled 11 missed more and cost more than the guess.
TEST(RandomProblems, AreInfeasibleOnlyWhereNoSmallChangeHelps) {
  expect_confirmed<bench::RandomHard<2, 1, 1, 0, 1, 0>>(0, 300, 90);
}

// Three were "infeasible": bounds a few tolerances from each other, between which no slope says that the miss
// can be lessened, and a hard limit in the way that a short step beyond it goes round. Two were "budget
// spent" with the residuals of another point than the one that was handed out.
TEST(RandomProblems, KeepTheVerdictThatBelongsToTheAnswer) {
  expect_confirmed<bench::RandomHard<2, 1, 1, 0, 1, 0>>(303000, 240, 80);
}
TEST(RandomProblems, AreSolvedBetweenBoundsCloserThanTheTolerance) {
  expect_confirmed<bench::RandomHard<2, 1, 1, 0, 1, 0>>(304300, 300, 100);
}
// One was "infeasible": a slope of 4e-5 by the input, whose bounds leave it 4e7, is flat by the tolerance.
TEST(RandomProblems, AreInfeasibleOnlyWhereNoLargeChangeHelps) {
  expect_confirmed<bench::RandomHard<2, 1, 1, 0, 1, 0>>(20003996, 12, 2);
}
// One was "infeasible" by a second restoration: the first one had found a point where everything holds.
TEST(RandomProblems, AreNotInfeasibleOnceAFeasiblePointIsFound) {
  expect_confirmed<bench::RandomHard<2, 1, 1, 0, 1, 0>>(14810, 12, 3);
}
// One was "at the floor" with the residuals of its inputs' simulation, 20 times what that allows.
TEST(RandomProblems, AreAtTheFloorWithResidualsOfTheAnswer) {
  expect_confirmed<bench::RandomStructured<1, 1, 0>>(21003901, 10, 3);
}

}  // namespace
}  // namespace chicane
