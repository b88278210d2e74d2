// SPDX-License-Identifier: MIT
#include "chicane/run/external_drive.hpp"

#include "chicane/run/make.hpp"
#include "chicane/run/simulated_car.hpp"
#include "support/chicane_test.hpp"

namespace chicane::run {
namespace {

using std::chrono::milliseconds;

class ExternalDriveTest : public testing::Test {
 protected:
  ExternalDriveTest() {
    scenario_.track = "oval";
    hooks_.on_frame = [this](const telemetry::Frame& frame) { frames_.push_back(frame); };
  }
  ExternalDrive make() {
    auto controller = make_controller(scenario_);
    EXPECT_TRUE(controller);
    return ExternalDrive({.scenario = scenario_}, std::move(*controller), hooks_);
  }
  static ExternalDrive::Sighting seen(ExternalDrive::Clock::time_point at, double x) {
    model::Measurement measured{.x = x, .speed = 5.0, .waypoint_count = 6};
    for (int i = 0; i < 6; ++i) measured.waypoints[static_cast<std::size_t>(i)] = {15.0 * (i - 1), 0.0};
    return {.received = at, .measured = measured, .delay = 0.1, .usual_delay = 0.1};
  }

  static void step(ExternalDrive& drive, const ExternalDrive::Sighting& now) {
    drive.step(now);
    drive.finish();
  }

  scenario::Scenario scenario_;
  ExternalDriveHooks hooks_;
  std::vector<telemetry::Frame> frames_;
};

TEST_F(ExternalDriveTest, AnswersWithAFiniteCommandAndHandsOnTheFrame) {
  ExternalDrive drive = make();
  const auto now = ExternalDrive::Clock::now();
  for (int i = 0; i < 5; ++i) {
    step(drive, seen(now + i * milliseconds{40}, 0.2 * i));
    EXPECT_TRUE(std::isfinite(drive.frame().result.command.steer));
  }
  ASSERT_EQ(frames_.size(), 5U);
  EXPECT_TRUE(frames_[0].begins);
  EXPECT_FALSE(frames_[1].begins);
  EXPECT_NEAR(*drive.gap(now + milliseconds{200}), 0.04, 1e-9);
}

TEST_F(ExternalDriveTest, ACycleWithoutAMeasurementIsOneInWhichNothingIsMeasured) {
  ExternalDrive drive = make();
  const auto now = ExternalDrive::Clock::now();
  step(drive, seen(now, 0.0));
  step(drive, {.received = now + milliseconds{40}, .delay = 0.1, .usual_delay = 0.1});
  EXPECT_FALSE(frames_[1].has_measurement);
  EXPECT_TRUE(std::isnan(frames_[1].measurement.x));
  EXPECT_TRUE(std::isfinite(frames_[1].result.command.throttle));
}

TEST_F(ExternalDriveTest, TrustsNothingLearnedAfterALongGap) {
  ExternalDrive drive = make();
  const auto now = ExternalDrive::Clock::now();
  for (const int ms : {0, 40, 1240, 1280, 1320}) step(drive, seen(now + milliseconds{ms}, 0.005 * ms));
  EXPECT_FALSE(frames_[1].begins);
  EXPECT_TRUE(frames_[2].begins);
  EXPECT_TRUE(frames_[3].begins);  // the first may have waited as long
  EXPECT_FALSE(frames_[4].begins);
}

TEST_F(ExternalDriveTest, CountsByTheClockOfASlowSimulatorAndSaysSoOnce) {
  std::vector<std::string> said;
  hooks_.on_clock = [&](std::string_view sentence) { said.emplace_back(sentence); };
  auto controller = test::good(make_controller(scenario_));
  ExternalDrive drive({.scenario = scenario_, .clock = {.is_estimated = true}}, std::move(*controller),
                      hooks_);
  const auto start = ExternalDrive::Clock::now();
  double x = 0.0, v = 0.0;
  for (int i = 0; i < 150; ++i) {
    ExternalDrive::Sighting now = seen(start + i * milliseconds{120}, x);
    now.measured->speed = v;
    for (int k = 0; k < 6; ++k)
      now.measured->waypoints[static_cast<std::size_t>(k)] = {15.0 * (std::floor(x / 15.0) + k - 1), 0.0};
    const double drive_on = drive.step(now).applied.throttle;
    drive.finish();
    const double gained = 0.06 * longitudinal_acceleration(scenario_.vehicle, drive_on, v);
    x += 0.06 * (v + 0.5 * gained);
    v = std::max(v + gained, 0.0);
  }
  ASSERT_EQ(said.size(), 1U);
  EXPECT_EQ(said[0], "the simulator's clock runs at 0.50 of the wall's: counted by it");
  const telemetry::Frame& last = frames_.back();
  EXPECT_NEAR(last.time - frames_[frames_.size() - 11].time, 0.6, 0.01);
  EXPECT_NEAR(last.measurement.delay, 0.05, 0.001);
  EXPECT_GT(v, 10.0);
  EXPECT_EQ(last.guard.reason, controller::GuardReason::kNone);
}

TEST_F(ExternalDriveTest, ARunThatBeginsAnewTrustsNothingLearned) {
  ExternalDrive drive = make();
  const auto now = ExternalDrive::Clock::now();
  step(drive, seen(now, 0.0));
  drive.begin_anew();
  step(drive, seen(now + milliseconds{40}, 70.0));
  EXPECT_TRUE(frames_[1].begins);
  EXPECT_NE(frames_[1].guard.reason, controller::GuardReason::kPositionJump);
}

model::Command ahead() { return {.steer = 0.0, .throttle = 0.5}; }

TEST(SimulatedCar, LeavesTimeOutThatItCannotCatchUpWith) {
  const auto car = SimulatedCar::create(scenario::Scenario{}, 0.0).value();
  EXPECT_EQ(car->catch_up(0.2, ahead), 0.0);
  EXPECT_NEAR(car->world.time(), 0.2, 0.021);
  const double late = car->catch_up(2.0, ahead);
  EXPECT_NEAR(late, 2.0 - 0.2 - SimulatedCar::kCatchUp, 0.021);
  EXPECT_NEAR(car->world.time(), 2.0 - late, 0.021);
}

TEST(StopNews, SaysOnceThatTheCarIsStoppedThatItStandsAndThatItDrivesOn) {
  const auto car = SimulatedCar::create(scenario::Scenario{}, 0.0).value();
  std::vector<std::string> said;
  StopNews news(scenario::Scenario{}, [&](std::string_view line) { said.emplace_back(line); });
  const auto why = [] { return std::string("nobody is there"); };
  EXPECT_FALSE(news.look(*car, true, 0.0, why)) << "it stood already";
  EXPECT_FALSE(news.look(*car, false, 0.0, why));
  static_cast<void>(car->catch_up(0.3, ahead));
  EXPECT_TRUE(news.look(*car, true, 9.0, why));
  EXPECT_FALSE(news.look(*car, true, 9.0, why));
  car->plant->reset({}, 0.0);
  EXPECT_FALSE(news.look(*car, true, 0.2, why));
  EXPECT_FALSE(news.look(*car, true, 0.0, why));
  EXPECT_FALSE(news.look(*car, false, 0.0, why));
  EXPECT_THAT(
      said, ElementsAre("no command in time: the car is stopped from 9.0 m/s: nobody is there",
                        HasSubstr("m inside the road's edge: nobody is there"), HasSubstr("drives on from")));
}

}  // namespace
}  // namespace chicane::run
