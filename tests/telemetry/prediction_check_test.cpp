// SPDX-License-Identifier: MIT
#include "chicane/telemetry/prediction_check.hpp"

#include <gtest/gtest.h>

namespace chicane::telemetry {
namespace {

/// Straight on along x at 10 m/s from (10 t, 0), points every 0.1 s.
controller::Plan plan_from(double time) {
  controller::Plan plan;
  plan.size = 5;
  for (int i = 0; i < plan.size; ++i) {
    controller::PlanPoint& point = plan.points[static_cast<std::size_t>(i)];
    point.time = time + 0.1 * i;
    point.x = 10.0 * point.time;
  }
  return plan;
}

TEST(PredictionCheck, HasNoErrorBeforeTheFirstPredictionIsDue) {
  PredictionCheck check;
  EXPECT_TRUE(std::isnan(check.error(0.0, {0.0, 0.0})));
  check.add(plan_from(0.1), 0.05);  // predicts a place at 0.15 s
  check.add(plan_from(0.15), 0.05);
  EXPECT_TRUE(std::isnan(check.error(0.1, {0.0, 0.0})));
}

TEST(PredictionCheck, IsTheDistanceFromWherePlansOfOneDelayAndPeriodAgoSaid) {
  PredictionCheck check;
  for (int cycle = 0; cycle < 20; ++cycle) {
    const double now = 0.05 * cycle;
    const double error = check.error(now, {10.0 * now + 0.3, 0.4});
    if (now < 0.1 + 0.05) {
      EXPECT_TRUE(std::isnan(error)) << now;
    } else {
      EXPECT_NEAR(error, 0.5, 1e-12) << now;  // a triangle of 3, 4, 5
    }
    check.add(plan_from(now + 0.1), 0.05);
  }
}

TEST(PredictionCheck, PredictsNothingAcrossACycleWithoutAPlan) {
  PredictionCheck check;
  for (int cycle = 0; cycle < 10; ++cycle) check.add(plan_from(0.1 + 0.05 * cycle), 0.05);
  check.add(controller::Plan{}, 0.05);
  EXPECT_TRUE(std::isnan(check.error(0.5, {5.0, 0.0})));
}

TEST(PredictionCheck, BeginsAnewWhenTimeRunsBackwards) {
  PredictionCheck check;
  for (int cycle = 0; cycle < 10; ++cycle) check.add(plan_from(100.0 + 0.05 * cycle), 0.05);
  for (int cycle = 0; cycle < 10; ++cycle) check.add(plan_from(0.1 + 0.05 * cycle), 0.05);
  EXPECT_NEAR(check.error(0.4, {4.0, 0.0}), 0.0, 1e-12);
}

TEST(PredictionCheck, ForgetsTheOldestWhenMoreIsPredictedThanItHolds) {
  PredictionCheck check;
  for (int cycle = 0; cycle < 1000; ++cycle) check.add(plan_from(0.01 * cycle), 0.01);
  EXPECT_TRUE(std::isnan(check.error(1.0, {10.0, 0.0})));
  EXPECT_NEAR(check.error(9.0, {90.0, 0.0}), 0.0, 1e-9);
}

}  // namespace
}  // namespace chicane::telemetry
