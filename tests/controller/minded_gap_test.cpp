// SPDX-License-Identifier: MIT
#include "chicane/controller/minded_gap.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace chicane::controller {
namespace {

using Problem = tracking::TrackingProblem;

/// A line along +x: what turns is the car.
road::ReferenceLine straight() {
  road::ReferenceLine line{101};
  EXPECT_TRUE(line.shape(100.0, 100, false));
  for (std::size_t i = 0; i < line.samples().size(); ++i)
    line.samples()[i].curve = {.position = {static_cast<double>(i), 0.0}, .tangent = {1.0, 0.0}};
  return line;
}

/// `side`: 1 turns left, -1 right.
double pushed(const model::PredictionModel& model, double heading, double& moment, double side = 1.0) {
  Problem problem;
  problem.model = &model;
  problem.horizon = 20;
  tracking::TrackingTrajectory along;
  along.horizon = 20;
  for (std::size_t i = 0; i <= 20; ++i) {
    along.x[i][Problem::kE] = heading + side * 0.06 * static_cast<double>(i);
    along.x[i][Problem::kVx] = 20.0;
    along.x[i][Problem::kR] = side * 2.0;
  }
  mind_helper_gap(problem, along, straight(), 10.0);
  double sum = 0.0;
  moment = 0.0;
  for (std::size_t i = 0; i < 20; ++i) {
    sum += problem.road.pushed_vy[i];
    moment += problem.road.pushed_vy[i] * static_cast<double>(i + 1);
  }
  return sum;
}

TEST(MindedGap, PushesOnceWhereTheHeadingPassesIt) {
  const model::PredictionModel model{model::udacity_params()};
  const double expected = -model::helper_gap_turn(model.vehicle(), 2.0) * 20.0;
  double moment = 0.0;
  EXPECT_NEAR(pushed(model, 0.5 * kPi - 0.33, moment), expected, 1e-12);
  EXPECT_NEAR(moment, 5.5 * expected, 1e-9) << "half-way through the sixth stage";
  EXPECT_NEAR(pushed(model, 0.5 * kPi - 0.01, moment), expected, 1e-12) << "in the first stage";
  EXPECT_EQ(pushed(model, 1.8, moment), 0.0);
  EXPECT_NEAR(pushed(model, 0.5 * kPi + 0.33, moment, -1.0), -expected, 1e-12) << "to the right";
  EXPECT_NEAR(moment, -5.5 * expected, 1e-9);
  const model::PredictionModel real{model::road_car_params()};
  EXPECT_EQ(pushed(real, 0.5 * kPi - 0.33, moment), 0.0);
}

}  // namespace
}  // namespace chicane::controller
