// SPDX-License-Identifier: MIT
#include "chicane/solver/detail/filter.hpp"
#include "support/chicane_test.hpp"

namespace chicane::solver {
namespace {

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
