// SPDX-License-Identifier: MIT
#include "chicane/solver/solution.hpp"
#include "support/chicane_test.hpp"

namespace chicane::solver {
namespace {

TEST(SolveStatus, TellsWhatMayBeUsed) {
  EXPECT_TRUE(usable(SolveStatus::kOptimal));
  EXPECT_TRUE(usable(SolveStatus::kBudgetSpent));
  EXPECT_FALSE(usable(SolveStatus::kStalled));
  EXPECT_FALSE(usable(SolveStatus::kInfeasible));
  EXPECT_FALSE(usable(SolveStatus::kNotFinite));
  EXPECT_FALSE(usable(SolveReport{}.status)) << "a report that nobody filled";
}

TEST(SolveStatus, HasANameForEachValueAndForNone) {
  EXPECT_EQ(to_string(SolveStatus::kOptimal), "optimal");
  EXPECT_EQ(to_string(SolveStatus::kNotFinite), "not_finite");
  EXPECT_EQ(to_string(static_cast<SolveStatus>(99)), "unknown");
}

TEST(WorstViolation, IsTheLargest) {
  WorstViolation worst;
  worst.consider(0.1, 1.0, 3, 0);
  worst.consider(0.4, 1.0, 5, 2);
  worst.consider(0.2, 1.0, 7, 1);
  SolveReport report;
  worst.tell(report);
  EXPECT_EQ(report.violation, 0.4);
  EXPECT_EQ(report.worst_stage, 5);
  EXPECT_EQ(report.worst_constraint, 2);
  EXPECT_FALSE(worst.is_above_a_cap());
}

TEST(WorstViolation, ThatIsAboveItsCapComesBeforeALargerOneBelow) {
  WorstViolation worst;
  worst.consider(5.0, 9.0, 1, 0);
  worst.consider(0.3, 0.2, 2, 1);
  worst.consider(7.0, 9.0, 3, 0);
  SolveReport report;
  worst.tell(report);
  EXPECT_TRUE(worst.is_above_a_cap());
  EXPECT_EQ(report.violation, 0.3);
  EXPECT_EQ(report.worst_stage, 2);
}

TEST(WorstViolation, LeavesAReportAloneWhereNothingIsViolated) {
  SolveReport report;
  WorstViolation{}.tell(report);
  EXPECT_EQ(report.violation, 0.0);
  EXPECT_EQ(report.worst_stage, -1);
}

}  // namespace
}  // namespace chicane::solver
