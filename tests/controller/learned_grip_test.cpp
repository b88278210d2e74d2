// SPDX-License-Identifier: MIT
#include "chicane/controller/tracking_guess.hpp"

#include "chicane/base/math.hpp"
#include "chicane/base/random.hpp"
#include "chicane/model/vehicle.hpp"
#include "support/chicane_test.hpp"

namespace chicane::controller {
namespace {

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
