// SPDX-License-Identifier: MIT
#include "chicane/solver/solution.hpp"
#include "chicane/solver/detail/filter.hpp"
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

TEST(WorstViolation, IsTheLargestButOneAboveItsCapBeforeAll) {
  WorstViolation worst;
  SolveReport report;
  worst.tell(report);
  EXPECT_EQ(report.violation, 0.0);
  EXPECT_EQ(report.worst_stage, -1);
  worst.consider(-0.5, 1e30, 0, 0);
  worst.consider(0.5, 1e30, 1, 2);  // metres, of no matter
  worst.consider(0.3, 1e30, 2, 0);
  worst.tell(report);
  EXPECT_EQ(report.violation, 0.5);
  EXPECT_EQ(report.worst_stage, 1);
  EXPECT_EQ(report.worst_constraint, 2);
  EXPECT_FALSE(worst.is_above_a_cap());
  worst.consider(0.2, 0.1, 2, 1);  // a share of the grip, above its cap
  worst.consider(0.7, 1e30, 3, 0);
  worst.consider(0.15, 0.1, 4, 1);
  worst.consider(std::nan(""), 0.1, 5, 1);
  worst.tell(report);
  EXPECT_EQ(report.worst_stage, 2);
  EXPECT_EQ(report.worst_constraint, 1);
  EXPECT_EQ(report.violation, 0.2);
  EXPECT_TRUE(worst.is_above_a_cap());
}

TEST(SolveStatus, HasANameForEachValueAndForNone) {
  EXPECT_EQ(to_string(SolveStatus::kOptimal), "optimal");
  EXPECT_EQ(to_string(SolveStatus::kNotFinite), "not_finite");
  EXPECT_EQ(to_string(static_cast<SolveStatus>(99)), "unknown");
}

TEST(Filter, RefusesWhatIsWorseInBoth) {
  Filter filter;
  filter.reset(100.0);
  filter.add({1.0, 10.0});
  EXPECT_FALSE(filter.accepts({1.0, 10.0}));
  EXPECT_FALSE(filter.accepts({2.0, 11.0}));
  EXPECT_TRUE(filter.accepts({0.5, 20.0}));
  EXPECT_TRUE(filter.accepts({2.0, 5.0}));
}

TEST(Filter, RefusesTooMuchMissAndWhatIsNoNumber) {
  Filter filter;
  filter.reset(100.0);
  EXPECT_TRUE(filter.accepts({99.0, 1e9}));
  EXPECT_FALSE(filter.accepts({101.0, 0.0}));
  EXPECT_FALSE(filter.accepts({std::numeric_limits<double>::quiet_NaN(), 0.0}));
  EXPECT_FALSE(filter.accepts({1.0, -std::numeric_limits<double>::infinity()}));
}

TEST(Filter, ForgetsOnlyTheLargestMissWhenItIsFull) {
  Filter filter;
  filter.reset(1e9);
  for (int i = 0; i < 1000; ++i) filter.add({1000.0 - i, static_cast<double>(i)});
  EXPECT_FALSE(filter.accepts({1.5, 999.5}));  // worse than the last
  EXPECT_TRUE(filter.accepts({999.5, 0.5}));   // the first is forgotten
  filter.reset(1e9);
  EXPECT_TRUE(filter.accepts({1.5, 999.5}));
}

}  // namespace
}  // namespace chicane::solver
