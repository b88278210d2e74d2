// SPDX-License-Identifier: MIT
#include "chicane/identify/identification.hpp"

#include "support/chicane_test.hpp"
#include "support/runs.hpp"

namespace chicane::identify {
namespace {

/// What was measured and sent in a run.
DriveLog drive_log(const test::Settings& settings, double steer_offset = 0.0) {
  const auto loop = test::loop_of(test::scenario_of(settings));
  DriveLog log{"run", {}, {}, true};
  double last = -1.0;
  while (!loop->is_over()) {
    loop->advance();
    const telemetry::Frame& frame = loop->frame();
    const model::Measurement& m = frame.measurement;
    if (m.time <= last) continue;
    last = m.time;
    double psi = m.psi;
    if (!log.samples.empty())
      psi = log.samples.back().psi + std::remainder(psi - log.samples.back().psi, 2.0 * kPi);
    log.samples.push_back({.time = m.time, .x = m.x, .y = m.y, .psi = psi, .speed = m.speed});
    log.commands.push_back(
        {m.time, frame.result.command.steer - steer_offset, frame.result.command.throttle});
  }
  return log;
}

const Estimate& of(const Identification& found, const std::string& key) {
  const auto each = std::find_if(found.estimates.begin(), found.estimates.end(),
                                 [&](const Estimate& estimate) { return estimate.key == key; });
  EXPECT_NE(each, found.estimates.end()) << key;
  return each == found.estimates.end() ? found.estimates.front() : *each;
}

/// The road car as one begins with who has measured little of it.
model::VehicleParams guess() {
  model::VehicleParams car = model::road_car_params();
  car.front_axle *= 1.06;
  car.rear_axle *= 1.06;
  car.cornering_front = 12.0;
  car.cornering_rear = 14.0;
  car.yaw_inertia = 1700.0;
  car.friction = 1.1;
  car.drive_acceleration = 4.5;
  car.brake_acceleration = 8.0;
  car.steer_lag = 0.08;
  return car;
}

TEST(Identification, FindsTheCarThatDrove) {
  const DriveLog log =
      drive_log({{"car", "road-car"}, {"track", "hairpins"}, {"laps", "1"}, {"latency_ms", "70"}}, 0.01);
  const auto found = test::good(identify({log}, guess(), {.hold_out = 0.3}));
  const model::VehicleParams truth = model::road_car_params();
  // Smooth steering tells delay and lag apart only by a few milliseconds of their sum.
  EXPECT_NEAR(1e3 * found->delay + of(*found, "steer_lag_ms").value, 120.0, 15.0);
  EXPECT_NEAR(found->delay, 0.07, 0.035);
  EXPECT_NEAR(of(*found, "steer_offset_deg").value, 0.573, 0.1);
  EXPECT_NEAR(of(*found, "wheelbase_m").value, truth.wheelbase(), 0.03 * truth.wheelbase());
  EXPECT_NEAR(found->vehicle.cornering_front, truth.cornering_front, 0.05 * truth.cornering_front);
  EXPECT_NEAR(found->vehicle.cornering_rear, truth.cornering_rear, 0.05 * truth.cornering_rear);
  EXPECT_NEAR(found->vehicle.brake_acceleration, truth.brake_acceleration, 0.1 * truth.brake_acceleration);
  EXPECT_FALSE(found->knows_tires()) << "the default preset leaves half of the grip";
  EXPECT_FALSE(of(*found, "friction").is_excited);
  for (const Estimate& each : found->estimates) {
    EXPECT_LE(each.low, each.value) << each.key;
    EXPECT_GE(each.high, each.value) << each.key;
  }
  const Estimate& rear = of(*found, "cornering_rear");
  EXPECT_GT(rear.high - rear.low, 0.055 * rear.value)
      << "a log without noise does not hide what the model lacks";
  ASSERT_EQ(found->held_out.size(), 3U);
  EXPECT_LT(found->held_out[0].position, 0.1);
  EXPECT_GT(found->held_out[0].kept_position, 0.1);
  EXPECT_TRUE(found->predicts());
  EXPECT_LT(found->held_out[2].position, 0.3);
}

// A public log whose commands moved nothing became a car with 398 % of the peak's slip, and race was
// recommended.
TEST(Identification, DoesNotPredictByCommandsThatDidNotDriveTheCar) {
  DriveLog log = drive_log({{"car", "road-car"}, {"track", "hairpins"}, {"laps", "1"}});
  std::vector<double> steer;
  for (const SentCommand& commands : log.commands) steer.push_back(commands.steer);
  // Quarters of the lap and signs; mirrored by the first quarter the commands predict by chance.
  for (const auto& [quarter, sign] : {std::pair{1U, 1.0}, {2U, -1.0}, {3U, -1.0}}) {
    for (std::size_t i = 0; i < steer.size(); ++i)
      log.commands[i].steer = sign * steer[(i + quarter * steer.size() / 4) % steer.size()];
    const auto found = test::good(identify({log}, guess(), {.hold_out = 0.3, .is_rough = true}));
    EXPECT_FALSE(found->predicts()) << found->held_out[0].position << ' ' << found->held_out[0].kept_position;
  }
}

// A public log of a car that spins: 26 degrees off after a third of a second, and a car that keeps its yaw
// rate 30.
TEST(Identification, DoesNotPredictWhatIsBeyondTheSensors) {
  Identification found;
  found.residual = {0.074, 0.032, 0.08};
  found.held_out = {{.ahead = 0.32, .position = 0.60, .yaw = 0.46, .kept_position = 0.74, .kept_yaw = 0.52}};
  EXPECT_FALSE(found.predicts());
  found.held_out[0].position = 0.4;
  found.held_out[0].yaw = 0.15;
  EXPECT_TRUE(found.predicts());
}

#ifdef CHICANE_SLOW_TESTS
// What the controllers' model leaves out was found in it: 9 % of the inertia, 3 % of the friction, 4 % of the
// rear tyres' stiffness, and 12 to 50 % of the inertia from other logs.
TEST(Identification, FindsTyresAndYawInertiaNearTheLimit) {
  const DriveLog log = drive_log(
      {{"car", "road-car"}, {"track", "hairpins"}, {"laps", "1"}, {"tracking_mpc.grip_share", "1"}});
  const auto found =
      test::good(identify({log}, guess(), {.hold_out = 0.0, .wheels = {.drive = {9.0, 10.0}}}));
  const model::VehicleParams truth = model::road_car_params();
  EXPECT_NEAR(found->vehicle.yaw_inertia, truth.yaw_inertia, 0.04 * truth.yaw_inertia);
  EXPECT_NEAR(found->vehicle.friction, truth.friction, 0.01 * truth.friction);
  EXPECT_NEAR(found->vehicle.cornering_front, truth.cornering_front, 0.02 * truth.cornering_front);
  EXPECT_NEAR(found->vehicle.cornering_rear, truth.cornering_rear, 0.02 * truth.cornering_rear);
}

// A car that steers on its own accord: no model has that.
TEST(Identification, SaysThatTheModelLacksSomething) {
  DriveLog log = drive_log({{"car", "road-car"}, {"track", "oval"}, {"laps", "1"}});
  const auto right = identify({log}, guess(), {.hold_out = 0.0});
  for (SentCommand& commands : log.commands) commands.steer += 0.02 * sin(1.5 * commands.time);
  const auto wrong = identify({log}, guess(), {.hold_out = 0.0});
  ASSERT_TRUE(right && wrong);
  EXPECT_GT(wrong->correlation, kWrongModel);
  const auto width = [](const Identification& found) {
    return of(found, "cornering_front").high / of(found, "cornering_front").low;
  };
  EXPECT_GT(std::log(width(*wrong)), 3.0 * std::log(width(*right)));
}
#endif

TEST(Identification, SaysWhatTheLogDoesNotExcite) {
  // Nearly straight, at a steady speed.
  DriveLog log{"straight", {}, {}, true};
  for (int i = 0; i < 800; ++i) {
    const double t = 0.05 * i;
    log.samples.push_back({.time = t, .x = 20.0 * t, .y = 0.0, .psi = 0.0, .speed = 20.0});
    log.commands.push_back({t, 0.0, 0.1});
  }
  const auto found = test::good(identify({log}, guess(), {.hold_out = 0.3}));
  for (const char* key : {"friction", "cornering_front", "cornering_rear", "yaw_inertia_kgm2", "wheelbase_m"})
    EXPECT_FALSE(of(*found, key).is_excited) << key;
  EXPECT_TRUE(of(*found, "steer_offset_deg").is_excited);
  EXPECT_FALSE(found->knows_tires());
  EXPECT_EQ(found->least_friction(), 0.0);
  EXPECT_LT(found->shown_friction(), 0.1);
}

TEST(Identification, TheLeastFrictionIsTheLowerEndOfWhatALogNearTheLimitTells) {
  const DriveLog log =
      drive_log({{"car", "road-car"}, {"track", "oval"}, {"laps", "1"}, {"tracking_mpc.grip_share", "1"}});
  const auto found = test::good(identify({log}, guess(), {.hold_out = 0.3}));
  ASSERT_TRUE(found->knows_tires()) << found->use_front << ' ' << found->use_rear;
  EXPECT_EQ(found->least_friction(), of(*found, "friction").low);
  EXPECT_LT(found->least_friction(), 1.2);
  EXPECT_GT(found->least_friction(), 0.9);
  EXPECT_GT(found->shown_friction(), 0.9);
  // What the page shows belongs together.
  EXPECT_EQ(found->correlations.size(), found->estimates.size());
  ASSERT_FALSE(found->stretches.empty());
  EXPECT_GT(found->stretches.front().samples.back().time, found->fitted.back().time);
  int front = 0;
  for (const int count : found->slip.front) front += count;
  EXPECT_EQ(static_cast<std::size_t>(front), found->fitted.size());
}

TEST(Identification, IsTheMirrorImageOfAMirroredLog) {
  const DriveLog log = drive_log({{"car", "road-car"}, {"track", "oval"}, {"laps", "1"}}, 0.01);
  DriveLog mirrored = log;
  for (Sample& sample : mirrored.samples) {
    sample.y = -sample.y;
    sample.psi = -sample.psi;
  }
  for (SentCommand& commands : mirrored.commands) commands.steer = -commands.steer;
  const auto a = identify({log}, guess(), {.hold_out = 0.5});
  const auto b = identify({mirrored}, guess(), {.hold_out = 0.5});
  ASSERT_TRUE(a && b);
  for (std::size_t i = 0; i < a->estimates.size(); ++i) {
    const Estimate& one = a->estimates[i];
    const double sign = one.key == "steer_offset_deg" ? -1.0 : 1.0;
    EXPECT_NEAR(one.value, sign * b->estimates[i].value, 0.02 * (1e-2 + std::fabs(one.value))) << one.key;
  }
}

// Whoever names no car got the one of the original simulator, for a model car, too.
TEST(Identification, TellsTheSizeOfACarByHowItTurns) {
  for (const char* car : {"f1tenth", "road-car", "orca-1-43"}) {
    const DriveLog log = drive_log({{"car", car}, {"track", "hairpins"}, {"laps", "1"}});
    const double wheelbase = test::scenario_of({{"car", car}}).vehicle.wheelbase();
    EXPECT_NEAR(turning_wheelbase({log}), wheelbase, 0.35 * wheelbase)
        << car;  // enough to tell it from others
  }
  EXPECT_TRUE(std::isnan(turning_wheelbase({})));
}

TEST(Identification, EndsWhenItIsAskedTo) {
  const DriveLog log = drive_log({{"car", "road-car"}, {"track", "oval"}, {"laps", "1"}});
  int asked = 0;
  const auto found =
      identify({log}, guess(), {.hold_out = 0.0, .progress = [&](double) { return ++asked < 2; }});
  ASSERT_TRUE(found);
  EXPECT_EQ(asked, 2);
  EXPECT_TRUE(found->held_out.empty());
  EXPECT_FALSE(of(*found, "steer_rate_limit_degps").is_excited) << "the first round holds it";
}

TEST(Identification, NeedsTenSecondsOfDriving) {
  DriveLog log{"short", {}, {}, true};
  for (int i = 0; i < 100; ++i) {
    log.samples.push_back({.time = 0.05 * i, .x = 1.0 * i, .y = 0.0, .psi = 0.0, .speed = 20.0});
    log.commands.push_back({0.05 * i, 0.0, 0.1});
  }
  EXPECT_THAT(test::refusal_of(identify({log}, guess(), {.hold_out = 0.0})),
              HasSubstr("expected at least 10 s"));
}

}  // namespace
}  // namespace chicane::identify
