// SPDX-License-Identifier: MIT
#include "chicane/base/integrate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "chicane/base/types.hpp"

namespace chicane {
namespace {

/// x' = (x₂, −x₁): a circle with the exact solution (cos t, −sin t) from (1, 0).
Vec2 circle(const Vec2& x) { return Vec2(x[1], -x[0]); }

template <class Step>
double error_after_one_second(Step step, int count) {
  Vec2 x(1.0, 0.0);
  for (int i = 0; i < count; ++i) x = step(x, 1.0 / count);
  return (x - Vec2(std::cos(1.0), -std::sin(1.0))).norm();
}

TEST(Integrate, EulerIsExactForConstantSpeed) {
  EXPECT_EQ(euler([](double) { return 2.0; }, 1.0, 0.25), 1.5);
}

TEST(Integrate, Rk4IsExactForCubicsInTime) {
  // State (t, y) with y' = 4 t³: exact up to rounding, since the rule has order four.
  const Vec2 x = rk4([](const Vec2& v) { return Vec2(1.0, 4.0 * v[0] * v[0] * v[0]); }, Vec2(1.0, 1.0), 0.5);
  EXPECT_NEAR(x[1], 1.5 * 1.5 * 1.5 * 1.5, 1e-14);
}

TEST(Integrate, EulerErrorHalvesAndRk4ErrorFallsSixteenfoldWithTheStep) {
  const auto by_euler = [](const Vec2& x, double dt) { return euler(circle, x, dt); };
  const auto by_rk4 = [](const Vec2& x, double dt) { return rk4(circle, x, dt); };
  EXPECT_NEAR(error_after_one_second(by_euler, 200) / error_after_one_second(by_euler, 400), 2.0, 0.05);
  EXPECT_NEAR(error_after_one_second(by_rk4, 20) / error_after_one_second(by_rk4, 40), 16.0, 1.0);
  EXPECT_LT(error_after_one_second(by_rk4, 100), 1e-10);
}

}  // namespace
}  // namespace chicane
