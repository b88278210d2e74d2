// SPDX-License-Identifier: MIT
#include "chicane/base/vec2.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace chicane {
namespace {

TEST(Vec2, IsZeroUnlessToldOtherwise) {
  constexpr Vec2 origin;
  EXPECT_EQ(origin.x(), 0.0);
  EXPECT_EQ(origin.y(), 0.0);
  static_assert(sizeof(Vec2) == 2 * sizeof(double), "points lie side by side in arrays");
}

TEST(Vec2, CalculatesByComponents) {
  const Vec2 a{3.0, -4.0};
  const Vec2 b{0.5, 2.0};
  EXPECT_EQ(a + b, Vec2(3.5, -2.0));
  EXPECT_EQ(a - b, Vec2(2.5, -6.0));
  EXPECT_EQ(-a, Vec2(-3.0, 4.0));
  EXPECT_EQ(2.0 * a, Vec2(6.0, -8.0));
  EXPECT_EQ(a * 2.0, Vec2(6.0, -8.0));
  EXPECT_EQ(a / 2.0, Vec2(1.5, -2.0));
  EXPECT_EQ(min(a, b), Vec2(0.5, -4.0));
  EXPECT_EQ(max(a, b), Vec2(3.0, 2.0));
  EXPECT_EQ(a.dot(b), -6.5);
  EXPECT_EQ(a.squared_norm(), 25.0);
  EXPECT_EQ(a.norm(), 5.0);
  EXPECT_NE(a, b);
}

TEST(Vec2, ChangesInPlace) {
  Vec2 a{1.0, 2.0};
  a += {1.0, 1.0};
  a *= 3.0;
  a -= {0.0, 1.0};
  a /= 4.0;
  EXPECT_EQ(a, Vec2(1.5, 2.0));
  a.x() = 7.0;
  a.y() = -7.0;
  EXPECT_EQ(a, Vec2(7.0, -7.0));
}

TEST(Vec2, DividesEachComponentOnce) { EXPECT_EQ(Vec2(5.0, 10.0) / 3.0, Vec2(5.0 / 3.0, 10.0 / 3.0)); }

TEST(Vec2, KnowsWhetherItIsFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(Vec2(1e308, -1e308).is_finite());
  EXPECT_FALSE(Vec2(kNan, 0.0).is_finite());
  EXPECT_FALSE(Vec2(0.0, -infinity).is_finite());
}

}  // namespace
}  // namespace chicane
