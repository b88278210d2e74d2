// SPDX-License-Identifier: MIT
// chicane bench: what it reports, never how fast.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <vector>

#include "bench_solves.hpp"

namespace chicane::apps {
namespace {

TEST(Spread, TakesTheNearestRank) {
  std::vector<double> values;
  for (int i = 1000; i > 0; --i) values.push_back(i);
  const Spread spread = spread_of(values);
  EXPECT_EQ(spread.median, 500.0);
  EXPECT_EQ(spread.p99, 990.0);
  EXPECT_EQ(spread.p999, 999.0);
  EXPECT_EQ(spread_of({}).median, 0.0);
}

TEST(TimeSolves, SolvesEveryFamilyToTheOptimum) {
  const std::atomic<bool> stop{false};
  for (const std::string_view family : families()) {
    const SolveRow row = time_solves(family, 6, 5, true, stop);
    EXPECT_EQ(row.instances, 5) << family;
    EXPECT_EQ(row.own.unsolved, 0) << family;
    EXPECT_GT(row.own.time_us.median, 0.0) << family;
    if (family.starts_with("corridor")) {
      EXPECT_TRUE(std::isnan(row.own.worst_gradient)) << family;
    } else {
      EXPECT_LE(row.own.worst_gradient, 1.1e-6) << family;  // the solver's own tolerance, and its defects
    }
    EXPECT_EQ(row.ipopt.has_value(), !ipopt_version().empty()) << family;
    if (!row.ipopt) continue;
    EXPECT_EQ(row.ipopt->unsolved, 0) << family;
    EXPECT_EQ(row.ipopt_warm.has_value(), family.ends_with("warm")) << family;
    EXPECT_LE(row.own.worst_excess, 1e-6) << family;
  }
}

TEST(TimeSolves, StopsWhenAsked) {
  const std::atomic<bool> stop{true};
  EXPECT_EQ(time_solves("cold0", 6, 5, true, stop).instances, 0);
}

}  // namespace
}  // namespace chicane::apps
