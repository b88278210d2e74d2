// SPDX-License-Identifier: MIT
#include "chicane/controller/tracking_guess.hpp"

#include "chicane/base/math.hpp"
#include "support/chicane_test.hpp"

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
  clamp_to_road(x);
  EXPECT_EQ(x[Problem::kD], 5.0);
  EXPECT_EQ(x[Problem::kE], -0.6);
  EXPECT_EQ(x[Problem::kVx], 0.0);
}

using Problem = tracking::TrackingProblem;

/// A line along +x: what iterations is the car.
road::ReferenceLine straight() {
  road::ReferenceLine line{101};
  EXPECT_TRUE(line.shape(100.0, 100, false));
  for (std::size_t i = 0; i < line.samples().size(); ++i)
    line.samples()[i].curve = {.position = {static_cast<double>(i), 0.0}, .tangent = {1.0, 0.0}};
  return line;
}

/// `side`: 1 iterations left, -1 right.
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
  add_helper_gap(problem, along, straight(), 10.0);
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
  return road::RacingRoad(points, 0.0, {.terms = {.grip = grip}});
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

TEST(Absence, IsLongAfterWhatIsBorneOfWhatWasThere) {
  Absence absence{0.3};
  absence.note(false, 10.0);
  EXPECT_FALSE(absence.is_long) << "it was never there";
  absence.note(true, 10.0);
  absence.note(false, 10.29);
  EXPECT_FALSE(absence.is_long);
  absence.note(false, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(absence.is_long);
  absence.note(false, 10.31);
  EXPECT_TRUE(absence.is_long);
  absence.note(true, 10.4);
  EXPECT_FALSE(absence.is_long);
  absence.note(false, 11.0);
  absence.reset();
  absence.note(false, 12.0);
  EXPECT_FALSE(absence.is_long);
  EXPECT_EQ(absence.longest, 0.3);
}

}  // namespace
}  // namespace chicane::controller
