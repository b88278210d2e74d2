// SPDX-License-Identifier: MIT
// chicane-bench: what it reports, never how fast.

#include <atomic>

#include "program/report.hpp"
#include "program/solves.hpp"
#include "support/chicane_test.hpp"

namespace chicane::bench {
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

References all_references() {
  References references;
#ifdef CHICANE_HAVE_IPOPT
  add_ipopt(references);
#endif
  return references;
}

TEST(TimeSolves, SolvesEveryFamilyToTheOptimum) {
  const std::atomic<bool> stop{false};
  References references = all_references();
  for (const std::string_view family : families()) {
    const SolveRow row = time_solves(family, 6, 5, references, stop);
    EXPECT_EQ(row.instances, 5) << family;
    EXPECT_EQ(row.own_instances, kOwnInstances * row.instances) << family;
    EXPECT_EQ(row.own.unsolved, 0) << family;
    EXPECT_GT(row.own.time_us.median, 0.0) << family;
    if (family.starts_with("corridor")) {
      EXPECT_TRUE(std::isnan(row.own.worst_gradient)) << family;
    } else {
      EXPECT_LE(row.own.worst_gradient, 1.1e-6) << family;  // the solver's own tolerance, and its defects
    }
    EXPECT_EQ(row.reference("ipopt") != nullptr, !references.versions.empty()) << family;
    EXPECT_EQ(row.reference("ipopt_hot") != nullptr, !references.versions.empty() && family == "warm")
        << family;
    for (const SolverColumn& column : row.references) {
      EXPECT_EQ(column.unsolved, 0) << family << " " << column.name;
      EXPECT_LE(column.worst_excess, 1e-6) << family << " " << column.name;
      if (!family.starts_with("corridor")) {
        EXPECT_LE(column.median_gradient, 1e-3) << family << " " << column.name;
      }
    }
  }
}

TEST(TimeSolves, StopsWhenAsked) {
  const std::atomic<bool> stop{true};
  References references = all_references();
  EXPECT_EQ(time_solves("cold0", 6, 5, references, stop).instances, 0);
}

}  // namespace
}  // namespace chicane::bench
