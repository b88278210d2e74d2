// SPDX-License-Identifier: MIT
#include "chicane/survey/sampled_line.hpp"
#include "support/chicane_test.hpp"

namespace chicane::survey {
namespace {

const std::vector<Vec2> kSquare{{0.0, 0.0}, {4.0, 0.0}, {4.0, 4.0}, {0.0, 4.0}};

TEST(SampledLine, MeasuresOpenAndClosedLines) {
  EXPECT_DOUBLE_EQ(length_of(kSquare, false), 12.0);
  EXPECT_DOUBLE_EQ(length_of(kSquare, true), 16.0);
}

TEST(SampledLine, HasEqualDistancesAndBeginsWhereTheLineDoes) {
  const std::vector<Vec2> closed = sampled(kSquare, true, 1.0);
  ASSERT_EQ(closed.size(), 16U);
  EXPECT_EQ(closed[0].x(), 0.0);
  for (std::size_t i = 0; i < closed.size(); ++i)
    EXPECT_NEAR((closed[(i + 1) % closed.size()] - closed[i]).norm(), 1.0, 1e-9) << i;
  const std::vector<Vec2> open = sampled(kSquare, false, 0.9);
  EXPECT_NEAR((open.back() - kSquare.back()).norm(), 0.0, 1e-9);
}

TEST(SampledLine, KnowsItsDirection) {
  const std::vector<Vec2> clockwise(kSquare.rbegin(), kSquare.rend());
  EXPECT_DOUBLE_EQ(signed_area(kSquare), 16.0);
  EXPECT_DOUBLE_EQ(signed_area(clockwise), -16.0);
}

TEST(SampledLine, TakesTheMedianOfUnorderedValues) {
  EXPECT_EQ(median({5.0, 1.0, 3.0}), 3.0);
  EXPECT_EQ(median({7.0}), 7.0);
}

}  // namespace
}  // namespace chicane::survey
