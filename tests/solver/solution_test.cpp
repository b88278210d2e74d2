// SPDX-License-Identifier: MIT
#include "chicane/solver/solution.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace chicane::solver
