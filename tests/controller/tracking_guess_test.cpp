// SPDX-License-Identifier: MIT
#include "chicane/controller/tracking_guess.hpp"

#include "chicane/base/math.hpp"
#include "chicane/base/random.hpp"
#include "chicane/model/vehicle.hpp"
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

/// A car with `grip` of what it is told weaves at 25 m/s for `seconds`; the model follows what it shows.
LearnedGrip driven_with(double grip, double seconds) {
  const model::VehicleParams told = model::road_car_params();
  model::PredictionModel assumed{told};
  tracking::StateEstimator truth{model::PredictionModel{model::with_grip(told, grip)}}, seen{assumed};
  tracking::CommandHistory sent;
  model::Measurement now{.speed = 25.0};
  truth.correct(now, sent);
  seen.correct(now, sent);
  LearnedGrip learned{assumed};
  learned.begin(seen, assumed);
  while (now.time < seconds) {
    const double time = now.time + 0.04;
    sent.add(now.time, {.steer = 0.05 * sin(1.3 * time), .throttle = 0.2});
    const model::State car = truth.predict(time, sent).state;
    now = {.time = time,
           .x = car.x,
           .y = car.y,
           .psi = car.psi,
           .speed = hypot(car.vx, car.vy),
           .steer = car.steer};
    truth.correct(now, sent);
    seen.correct(now, sent);
    if (learned.see(now, sent) != LearnedGrip::Change::kModel) continue;
    assumed.set_vehicle(model::with_grip(told, learned.share()));
    seen.set_model(assumed);
    learned.begin(seen, assumed);
  }
  return learned;
}

TEST(LearnedGrip, FollowsWhatTheTyresShow) {
  for (const double grip : {0.6, 0.8, 1.0, 1.2}) {
    const LearnedGrip learned = driven_with(grip, 20.0);
    EXPECT_TRUE(learned.is_shown()) << grip;
    EXPECT_NEAR(learned.share(), grip, LearnedGrip::kStep + 0.02) << grip;
    EXPECT_LE(learned.lower(), learned.share() + LearnedGrip::kStep) << grip;
  }
}

// Up with what may be relied on, down only with what is sure.
TEST(LearnedGrip, PlansForMoreOrLessOnlyWhereTheTyresSaySo) {
  const LearnedGrip learned = driven_with(0.8, 20.0);
  EXPECT_NEAR(learned.for_plan(0.6), 0.8, 0.05);
  EXPECT_LE(learned.for_plan(0.6), learned.lower());
  EXPECT_EQ(learned.for_plan(learned.lower()), learned.lower());
  EXPECT_LT(learned.for_plan(1.0), 0.85);
  for (const double near : {-0.01, 0.0, 0.01}) {
    const double planned = learned.share() + near;
    EXPECT_EQ(learned.for_plan(planned), planned) << near;
  }
}

// A little more grip than told may be the model's error at that speed: a lap planned for 1.04 was lost at
// Monza.
TEST(LearnedGrip, TakesALittleMoreForWhatWasTold) {
  const LearnedGrip learned = driven_with(1.06, 20.0);
  EXPECT_GT(learned.estimate().value, 1.04);
  EXPECT_EQ(learned.share(), 1.0);
  EXPECT_EQ(learned.for_plan(0.6), 1.0);
  EXPECT_EQ(learned.for_plan(1.0), 1.0);
  EXPECT_GT(driven_with(1.12, 20.0).for_plan(0.6), 1.07);
}

// docs/limit.md, eq. 19.
TEST(LearnedGrip, LetsACarSlideThatIsAsToldAndAnsweredSoon) {
  LearnedGrip learned = driven_with(1.0, 20.0);
  learned.configure(model::udacity_params());
  const double longest = model::SlidingBound::longest_delay(model::udacity_params());
  const double most = longest - 0.04 - 0.005;  // less the period, and what the test's car is unsure by
  EXPECT_TRUE(learned.may_slide(1.0, most, false));
  EXPECT_TRUE(learned.may_slide(0.95, most, false));
  EXPECT_TRUE(learned.may_slide(1.05, most, false));
  EXPECT_FALSE(learned.may_slide(0.94, most, false));
  EXPECT_FALSE(learned.may_slide(1.06, most, false));
  EXPECT_FALSE(learned.may_slide(1.0, longest - 0.039, false));
  EXPECT_TRUE(learned.may_slide(1.0, longest - 0.039, true)) << "which slides already";
  EXPECT_FALSE(learned.may_slide(1.0, longest, true));
  for (const double other : {0.94, 1.06}) {
    LearnedGrip otherwise = driven_with(other, 20.0);
    otherwise.configure(model::udacity_params());
    EXPECT_FALSE(otherwise.may_slide(1.0, most, false)) << "another car than told";
  }
  learned.configure(model::road_car_params());
  EXPECT_FALSE(learned.may_slide(1.0, 0.0, false)) << "its tyres share their force";
  learned.configure(model::udacity_params());
  learned.forget();
  EXPECT_FALSE(learned.may_slide(1.0, most, false)) << "before its tyres have shown anything";
}

TEST(LearnedGrip, KeepsTheConfiguredGripUntilThen) {
  LearnedGrip learned = driven_with(0.8, 0.5);
  EXPECT_FALSE(learned.is_shown());
  EXPECT_EQ(learned.share(), 1.0);
  learned = driven_with(0.8, 20.0);
  learned.forget();
  EXPECT_FALSE(learned.is_shown());
  EXPECT_EQ(learned.share(), 1.0);
}

/// The share of slip for a lap after 20 s of weaving at 30 m/s, measured with noise of this heading [rad].
double slip_share(double heading_noise, double rate_limit = 1.5, double planned = 1.0) {
  model::VehicleParams car = model::road_car_params();
  car.steer_rate_limit = rate_limit;
  const model::PredictionModel model{car};
  tracking::StateEstimator truth{model}, seen{model};
  seen.estimate_disturbance(true);
  tracking::CommandHistory sent;
  truth.correct({.speed = 30.0}, sent);
  seen.correct({.speed = 30.0}, sent);
  SlipReserve reserve;
  EXPECT_EQ(reserve.for_plan(1.0), 1.0) << "before a corner";
  Random random{3};
  for (double time = 0.04; time < 20.0; time += 0.04) {
    sent.add(time - 0.04, {.steer = 0.05 * sin(1.3 * time), .throttle = 0.2});
    const model::State at = truth.predict(time, sent).state;
    model::Measurement now{.time = time, .x = at.x, .y = at.y, .psi = at.psi, .speed = hypot(at.vx, at.vy)};
    truth.correct(now, sent);
    now.x += 10.0 * heading_noise * random.normal();
    now.y += 10.0 * heading_noise * random.normal();
    now.psi += heading_noise * random.normal();
    seen.correct(now, sent);
    reserve.see(seen, time, 0.1);
  }
  return reserve.for_plan(planned);
}

TEST(SlipReserve, GrowsWithTheNoiseOfTheSensorsAndWithASlowSteering) {
  EXPECT_EQ(slip_share(0.0), 1.0) << "a car that is surely as it seems gives nothing away";
  const double usual = slip_share(0.002);
  EXPECT_LT(usual, 0.9);
  EXPECT_GT(usual, 0.5);
  EXPECT_LT(slip_share(0.004), usual);
  EXPECT_LT(slip_share(0.002, 0.4), usual);
  EXPECT_GE(slip_share(0.1), 1.0 - SlipReserve::kMost - 1e-9) << "no lap stands";
}

TEST(SlipReserve, KeepsALapThatIsNearlyTheWantedOne) {
  const double wanted = slip_share(0.002);
  EXPECT_EQ(slip_share(0.002, 1.5, wanted + 0.01), wanted + 0.01);
  EXPECT_EQ(slip_share(0.002, 1.5, 0.4), wanted);
}

}  // namespace
}  // namespace chicane::controller
