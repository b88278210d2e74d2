// SPDX-License-Identifier: MIT
#include "chicane/controller/other_line.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "chicane/base/math.hpp"

namespace chicane::controller {
namespace {

using Problem = tracking::TrackingProblem;

/// A closed circle to the left round the origin, which begins at (radius, 0).
road::ReferenceLine ring(double radius) {
  road::ReferenceLine line(241);
  EXPECT_TRUE(line.shape(kTwoPi * radius, 240, true));
  for (std::size_t i = 0; i < line.samples().size(); ++i) {
    const double angle = kTwoPi * static_cast<double>(i) / 240.0;
    line.samples()[i].curve = {.position = {radius * std::cos(angle), radius * std::sin(angle)},
                               .tangent = {-std::sin(angle), std::cos(angle)},
                               .heading = angle + 0.5 * kPi,
                               .curvature = 1.0 / radius};
  }
  return line;
}

/// Ten stages over the line's beginning, 52 m from the middle and turned by 0.1 rad: where the car is, and
/// what an answer along the ring of 50 m says of it.
struct Answer {
  Plan plan;
  tracking::TrackingTrajectory along;

  Answer() {
    plan.size = 11;
    along.horizon = 10;
    for (std::size_t k = 0; k < 11; ++k) {
      const double angle = -0.1 + 0.02 * static_cast<double>(k);
      plan.points[k] = {.x = 52.0 * std::cos(angle),
                        .y = 52.0 * std::sin(angle),
                        .psi = angle + 0.5 * kPi + 0.1,
                        .speed = 20.0,
                        .command = {}};
      along.x[k] = {50.0 * 0.02 * static_cast<double>(k), -2.0, 0.1, 20.0, 0.5, 0.4, 0.05, 1.0};
    }
  }
};

TEST(MoveToLine, LeavesTheStatesWhereTheyAre) {
  Answer answer;
  const tracking::TrackingTrajectory before = answer.along;
  const road::ReferenceLine line = ring(54.0);
  ASSERT_TRUE(move_to_line(line, answer.plan, 2.0, 15.0, answer.along));
  for (std::size_t k = 0; k < 11; ++k) {
    SCOPED_TRACE(k);
    const auto& x = answer.along.x[k];
    EXPECT_NEAR(x[Problem::kS], 54.0 * 0.02 * static_cast<double>(k), 1e-6);  // over the seam, too
    EXPECT_NEAR(x[Problem::kD], 2.0, 1e-6);
    EXPECT_NEAR(x[Problem::kE], 0.1, 1e-6);
    for (const std::size_t own :
         {std::size_t{Problem::kVx}, std::size_t{Problem::kVy}, std::size_t{Problem::kR}})
      EXPECT_EQ(x[own], before.x[k][own]);
  }
}

TEST(MoveToLine, OfTheSameLineChangesNothing) {
  Answer answer;
  const tracking::TrackingTrajectory before = answer.along;
  ASSERT_TRUE(move_to_line(ring(50.0), answer.plan, 2.0, 15.0, answer.along));
  for (std::size_t k = 0; k < 11; ++k)
    for (std::size_t i = 0; i < before.x[k].size(); ++i)
      EXPECT_NEAR(answer.along.x[k][i], before.x[k][i], 1e-6);
}

TEST(MoveToLine, RefusesALineThatIsFarOrEmptyAndAnAnswerWithoutAPlan) {
  Answer answer;
  EXPECT_FALSE(move_to_line(ring(30.0), answer.plan, 2.0, 15.0, answer.along));
  EXPECT_FALSE(move_to_line(road::ReferenceLine(10), answer.plan, 2.0, 15.0, answer.along));
  answer.plan.size = 0;
  EXPECT_FALSE(move_to_line(ring(50.0), answer.plan, 2.0, 15.0, answer.along));
}

/// A ring as a lap, planned with a share of the grip.
road::RacingRoad lap(double radius, double grip) {
  std::vector<road::LinePoint> points;
  for (int i = 0; i <= 240; ++i) {
    const double angle = kTwoPi * i / 240.0;
    road::LinePoint point;
    point.position = {radius * std::cos(angle), radius * std::sin(angle)};
    point.heading = angle + 0.5 * kPi;
    point.curvature = 1.0 / radius;
    point.speed = 20.0;
    points.push_back(point);
  }
  return road::RacingRoad(points, 0.0, {.grip = grip});
}

TEST(BesideLap, IsHowFarThePlanWillHaveToBeCorrected) {
  Answer answer;
  for (std::size_t k = 0; k < 11; ++k) answer.plan.points[k].time = 0.3 * static_cast<double>(k);
  answer.plan.points[3].x += 1.5;  // 0.9 s ahead
  answer.plan.points[8].x += 9.0;  // 2.4 s ahead: there is time for that
  const road::RacingRoad now = lap(52.0, 0.6);
  EXPECT_NEAR(beside_lap(lap(52.4, 0.8), &now, answer.plan, 2.0, 15.0), 1.1, 0.01);
  EXPECT_EQ(beside_lap(lap(52.4, 0.5), &now, answer.plan, 2.0, 15.0), 0.0) << "less grip is braked for";
  EXPECT_NEAR(beside_lap(lap(52.4, 0.8), nullptr, answer.plan, 2.0, 15.0), 0.4, 0.01)
      << "of the first lap the car's own place counts";
  answer.plan.size = 0;
  EXPECT_EQ(beside_lap(lap(52.4, 0.8), &now, answer.plan, 2.0, 15.0), 0.0) << "nothing is planned";
}

}  // namespace
}  // namespace chicane::controller
