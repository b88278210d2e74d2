// SPDX-License-Identifier: MIT
#include "chicane/run/account.hpp"

#include "chicane/base/math.hpp"
#include "support/alloc_guard.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"

namespace chicane::run {
namespace {

constexpr double kRadius = 60.0;
constexpr double kSpeed = 12.0;
constexpr double kLapTime = kTwoPi * kRadius / kSpeed;
constexpr double kPeriod = 0.12;  // of telemetry with the original's latency [s]

/// Circle about the origin, counter-clockwise, s = 0 at (kRadius, 0), 5 m to the left edge and 4 m to the
/// right.
road::Track circle() {
  return test::circle_road(kRadius, 120, 5.0, 4.0, {.spacing = 2.0, .smoothing_sigma = 0.0});
}

/// Somebody else's car that goes round, as telemetry tells of it.
class Telemetry {
 public:
  explicit Telemetry(Roadside& roadside) : roadside_{roadside} {}
  const telemetry::Frame& next(double left = 0.0) {
    const double angle = kSpeed / kRadius * driven_for_;
    frame_->time = 100.0 + driven_for_;
    frame_->has_measurement = true;
    frame_->measurement.x = (kRadius - left) * std::cos(angle);
    frame_->measurement.y = (kRadius - left) * std::sin(angle);
    frame_->measurement.psi = angle + kPi / 2.0;
    frame_->measurement.speed = kSpeed;
    roadside_.judge(*frame_);
    driven_for_ += kPeriod;
    return *frame_;
  }
  const telemetry::Frame& broken() {
    frame_->has_measurement = false;
    roadside_.judge(*frame_);
    return *frame_;
  }
  [[nodiscard]] double driven_for() const { return driven_for_; }

 private:
  Roadside& roadside_;
  double driven_for_ = 0.0;
  std::unique_ptr<telemetry::Frame> frame_ = std::make_unique<telemetry::Frame>();
};

TEST(Roadside, TimesLapsOfACarThatOthersSimulate) {
  const road::Track track = circle();
  Roadside roadside(&track, {});
  Telemetry car(roadside);
  EXPECT_TRUE(car.next().is_judged);
  while (car.driven_for() < 2.5 * kLapTime) car.next();
  const telemetry::Frame& frame = car.next(1.5);
  EXPECT_EQ(frame.lap, 2);
  EXPECT_NEAR(frame.lateral_error, 1.5, 1e-3);
  EXPECT_NEAR(frame.s, kRadius * (kSpeed / kRadius * (car.driven_for() - kPeriod) - 2.0 * kTwoPi), 0.1);
  EXPECT_EQ(frame.completed_lap.lap, 2);
  EXPECT_TRUE(frame.completed_lap.is_clean);
  // Even motion is interpolated; the spline through 120 points errs by 1e-4 of a length at most.
  EXPECT_NEAR(frame.completed_lap.lap_time, kLapTime, 1e-4 * kLapTime);
  for (const double sector : frame.completed_lap.sector_times) EXPECT_NEAR(sector, kLapTime / 3.0, 2e-3);
  EXPECT_NEAR(frame.completed_lap.mean_speed, kSpeed, 1e-9);

  const telemetry::RunSummary run = roadside.summary();
  EXPECT_EQ(run.track, "circle");
  ASSERT_EQ(run.laps.size(), 2U);
  EXPECT_EQ(run.laps[1].lap_time, frame.completed_lap.lap_time);
  EXPECT_NEAR(run.laps[1].rms_lateral_error, 0.0, 1e-3);
  EXPECT_EQ(run.off_track_events, 0);
  EXPECT_GT(run.laps[1].min_edge_distance, 1.0);
}

TEST(Roadside, SeesWheelsBeyondTheEdge) {
  const road::Track track = circle();
  Roadside roadside(&track, {});
  Telemetry car(roadside);
  while (car.driven_for() < 1.2 * kLapTime) car.next(car.driven_for() < 0.5 * kLapTime ? 4.8 : 0.0);
  const telemetry::RunSummary run = roadside.summary();
  ASSERT_EQ(run.laps.size(), 1U);
  EXPECT_LT(run.laps[0].min_edge_distance, 0.0);
  EXPECT_EQ(run.off_track_events, 1);
  EXPECT_NEAR(run.out_of_track_time, 0.5 * kLapTime, 2.0 * kPeriod);
  EXPECT_FALSE(car.next().completed_lap.is_clean);
}

TEST(Roadside, JudgesNothingOnARoadThatNobodyKnows) {
  Roadside roadside(nullptr, {});
  Telemetry car(roadside);
  for (int i = 0; i < 600; ++i) EXPECT_FALSE(car.next().is_judged);
  const telemetry::RunSummary run = roadside.summary();
  EXPECT_EQ(run.track, "");
  EXPECT_EQ(run.cycles, 600U);
  EXPECT_TRUE(std::isnan(run.total.min_edge_distance));
  EXPECT_NEAR(run.total.mean_speed, kSpeed, 1e-9);
}

TEST(Roadside, TimesLapsOnARoadThatNobodyKnows) {
  Roadside roadside(nullptr, {});
  Telemetry car(roadside);
  while (car.driven_for() < 2.2 * kLapTime) car.next();
  EXPECT_EQ(car.next().lap, 2);
  const auto lap = test::good(roadside.take_lap());
  EXPECT_NEAR(lap->lap_time, kLapTime, 1e-3 * kLapTime);
  EXPECT_FALSE(std::isfinite(lap->min_edge_distance));
  const telemetry::RunSummary run = roadside.summary();
  ASSERT_EQ(run.laps.size(), 2U);
  EXPECT_NEAR(run.laps[1].mean_speed, kSpeed, 1e-9);
  EXPECT_EQ(run.off_track_events, 0);
}

TEST(Roadside, ForgetsWhatWasJudgedByAnotherRoad) {
  const road::Track track = circle();
  Roadside roadside(&track, {});
  Telemetry car(roadside);
  EXPECT_TRUE(car.next(20.0).is_off_track);
  roadside.forget_track();
  EXPECT_FALSE(car.next().is_judged);
  while (car.driven_for() < 1.2 * kLapTime) car.next();
  const telemetry::RunSummary run = roadside.summary();
  EXPECT_EQ(run.track, "");
  EXPECT_EQ(run.off_track_events, 0);
  EXPECT_EQ(run.laps_completed, 1);
}

TEST(Roadside, KeepsTheLapsOverTelemetryThatWasBroken) {
  const road::Track track = circle();
  Roadside roadside(&track, {});
  Telemetry car(roadside);
  while (car.driven_for() < 1.1 * kLapTime) car.next();
  const telemetry::Frame& broken = car.broken();
  EXPECT_FALSE(broken.is_judged);
  EXPECT_EQ(broken.completed_lap.lap, 1);
}

TEST(Roadside, GoesOnCountingWithTheNextCar) {
  const road::Track track = circle();
  Roadside roadside(&track, {});
  Telemetry first(roadside);
  while (first.driven_for() < 1.7 * kLapTime) first.next();
  roadside.resume();
  Telemetry second(roadside);
  EXPECT_EQ(second.next(6.0).lap, 1) << "the lap that was under way does not count";
  EXPECT_TRUE(roadside.take_lap());
  EXPECT_FALSE(roadside.take_lap()) << "each lap is told once";
  while (second.driven_for() < 1.1 * kLapTime) second.next();
  EXPECT_EQ(second.next().lap, 2);
  EXPECT_EQ(roadside.take_lap()->lap, 2);
  const telemetry::RunSummary run = roadside.summary();
  ASSERT_EQ(run.laps.size(), 2U);
  EXPECT_NEAR(run.laps[0].lap_time, kLapTime, 1e-3 * kLapTime);
  EXPECT_NEAR(run.laps[1].lap_time, kLapTime, 2e-2 * kLapTime);  // it began beside the line
  EXPECT_EQ(run.end_reason, "stopped");
}

TEST(Roadside, AllocatesNothingWhileItLooks) {
  const road::Track track = circle();
  Roadside roadside(&track, {});
  Telemetry car(roadside);
  car.next();
  const test::AllocationGuard guard;
  while (car.driven_for() < 1.5 * kLapTime) car.next();
  EXPECT_EQ(guard.count(), 0);
}

}  // namespace
}  // namespace chicane::run
