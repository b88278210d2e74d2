// SPDX-License-Identifier: MIT
#include "chicane/controller/path_law.hpp"

#include <gtest/gtest.h>

namespace chicane::controller {
namespace {

using Problem = tracking::TrackingProblem;

TEST(PathLaw, SteersAlongTheLineAndBackToIt) {
  const model::PredictionModel model{model::udacity_params()};
  Problem problem;
  problem.model = &model;
  problem.road.curvature[3] = 0.02;
  problem.road.speed[3] = 25.0;
  Problem::State x{};
  x[Problem::kVx] = 20.0;
  EXPECT_NEAR(path_law(problem, 3, x)[0], 0.02 * model.vehicle().wheelbase(), 1e-12);
  EXPECT_NEAR(path_law(problem, 3, x)[1], 5.0, 1e-12);
  x[Problem::kD] = 1.0;
  EXPECT_LT(path_law(problem, 3, x)[0], 0.02 * model.vehicle().wheelbase());
}

TEST(PathLaw, PullsAGuessBackToTheRoad) {
  Problem::State x{};
  x[Problem::kD] = 12.0;
  x[Problem::kE] = -2.0;
  x[Problem::kVx] = -1.0;
  keep_sane(x);
  EXPECT_EQ(x[Problem::kD], 5.0);
  EXPECT_EQ(x[Problem::kE], -0.6);
  EXPECT_EQ(x[Problem::kVx], 0.0);
}

}  // namespace
}  // namespace chicane::controller
