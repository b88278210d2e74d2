// SPDX-License-Identifier: MIT
// What every file in data/cars/ promises: a car of the shelf is a plant and a model of it that agree, and
// drives.

#include "chicane/protocol/library.hpp"
#include "chicane/run/make.hpp"
#include "chicane/scenario/scenario.hpp"
#include "closed_loop/drive.hpp"
#include "sim/plant_experiment.hpp"
#include "support/results.hpp"

namespace chicane::run {
namespace {

std::vector<std::string> cars() {
  std::vector<std::string> names;
  for (const protocol::Entry& entry : protocol::entries(protocol::Shelf::kCar)) names.push_back(entry.name);
  return names;
}

class EveryCar : public testing::TestWithParam<std::string> {
 protected:
  scenario::Scenario scenario_ = test::scenario_of({{"car", GetParam()}});
  std::unique_ptr<sim::Plant> plant_ = std::move(*make_plant(scenario_));
};

TEST(Cars, Ship) {
  EXPECT_THAT(cars(), testing::IsSupersetOf({"bmw-320i", "formula-student", "indy", "road-car", "tum-1200",
                                             "udacity", "vw-vanagon"}));
}

// What the file says of the plant and does not say of the model comes out alike, and what it says of both
// agrees.
TEST_P(EveryCar, SpeedsUpAndBrakesAsItsModelPredicts) {
  const model::VehicleParams& car = scenario_.vehicle;
  const double grip = car.cornering_friction() * std::min(car.load_constant, 9.81);
  for (const double share : {0.3, -0.3}) {  // far from what its tyres hold: the model's law knows no slip
    for (const double equivalent : {10.0, 20.0}) {
      const double v = equivalent * std::sqrt(car.scale);
      const double throttle = share > 0.0
                                  ? throttle_for(car, share * grip, v)
                                  : std::max(throttle_for(car, share * grip, v), -car.brake_throttle_limit);
      plant_->reset({}, v);
      const auto run = sim::experiment::drive_straight(*plant_, throttle, 0.8);
      const auto& from = run[run.size() / 2];
      const double measured = (run.back().speed - from.speed) / (run.back().time - from.time);
      const double assumed = longitudinal_acceleration(car, throttle, 0.5 * (from.speed + run.back().speed));
      // The slip of the wheels, and the share of the lag that is left after 0.4 s.
      const double tolerance = 0.05 * std::fabs(assumed) + (GetParam() == "udacity" ? 0.5 : 0.05);
      EXPECT_NEAR(measured, assumed, tolerance) << throttle << " at " << v;
    }
  }
}

TEST_P(EveryCar, TurnsAsItsModelPredicts) {
  for (const double equivalent : {12.0, 20.0}) {
    const double v = equivalent * std::sqrt(scenario_.vehicle.scale);
    const auto mismatch = sim::experiment::compare(*plant_, scenario_.vehicle, v, 2.5);
    // docs/measured/plants.md has 3 to 9 % for the first two cars. This single track stands beside the car as
    // it is, and its slip angles have a floor of 1 m/s, which is much for a model car; controllers see those
    // in full size.
    EXPECT_LT(mismatch.yaw_rate, scenario_.vehicle.scale < 1.0 ? 0.25 : 0.12) << v;
  }
}

class LapsOf : public testing::TestWithParam<std::string> {};

// Three laps: the guard's stops once drove a car off the road in the third. The guard that is on refuses
// nothing: its stops fit cars of much drag, too, and those that are hardly stable. vw-vanagon slides in two
// bends of either track, its rear axle beyond the peak.
TEST_P(LapsOf, ACarAreCleanWithTheDefaultSettings) {
  for (const char* track : {"oval", "lakeside"}) {
    const bool is_turn = (GetParam() == "bmw-320i") == (track[0] == 'l');
    if (!kDrivesAll && !is_turn) continue;
    const auto run = drive_cleanly({{"car", GetParam()}, {"track", track}, {"laps", "3"}});
    const auto refused = run.guard_reasons[static_cast<std::size_t>(controller::GuardReason::kNoWayToStop)];
    // Cars that are hardly stable by themselves at their speed: a stop that fits has to be found anew at
    // times.
    EXPECT_LE(refused, GetParam() == "vw-vanagon"        ? 30U
                       : GetParam() == "formula-student" ? 3U
                                                         : 0U)
        << track << ": answers refused by the guard; a car that ships laps without, or has its number here";
  }
}

// It braked from 40 m/s into the bend after the straight until its rear axle slid, and stood beside the line
// for good.
TEST(Cars, ThatBrakingMakesUnstableAreBrakedIntoBendsWithoutSpinning) {
  drive_cleanly({{"car", "vw-vanagon"}, {"track", "speedway"}, {"laps", kDrivesAll ? "2" : "1"}});
}

TEST(Cars, ThatAreOrdinaryBrakeFromTopSpeedWithoutSpinning) {
  drive_cleanly({{"car", "road-car"},
                 {"track", "speedway"},
                 {"laps", kDrivesAll ? "2" : "1"},
                 {"latency_ms", "300"},
                 {"time_limit_s", "300"}});
}

TEST(Cars, ThatCannotTurnSoTightlyAreRefusedWithPlaceAndRadius) {
  const auto loop = ClosedLoop::create(test::scenario_of({{"car", "indy"}, {"track", "hairpins"}}));
  ASSERT_FALSE(loop);
  EXPECT_EQ(loop.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(
      loop.error().message,
      testing::MatchesRegex("track: hairpins is not for the car indy: the bend at s = .* m leaves room for a "
                            "radius of 1.* m, and the car's full lock drives no less than 10.44 m.*"));
}

TEST(Cars, ThatAreTooWideAreRefusedWithPlaceAndWidth) {
  EXPECT_THAT(test::refusal_of(ClosedLoop::create(
                  test::scenario_of({{"car", "f1tenth"}, {"track", "oval"}, {"track_scale", "0.02"}}))),
              testing::HasSubstr("track: oval is not for the car f1tenth: the road is 0.22 m wide"));
}

// The track of a model car is as small as the car, unless something else is said.
TEST(Cars, DriveOnTracksOfTheirScale) {
  const auto scaled = test::scenario_of({{"car", "f1tenth"}, {"track", "oval"}});
  const auto large = test::scenario_of({{"car", "road-car"}, {"track", "oval"}});
  const auto told = test::scenario_of({{"car", "f1tenth"}, {"track", "oval"}, {"track_scale", "0.2"}});
  const double length = make_track(large)->length();
  EXPECT_EQ(scaled.size_of_track(), 0.1);
  EXPECT_NEAR(make_track(scaled)->length(), 0.1 * length, 1e-9);
  EXPECT_NEAR(make_track(told)->length(), 0.2 * length, 1e-9);
}

std::string name_of(const testing::TestParamInfo<std::string>& car) {
  std::string name;
  for (const char c : car.param) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += c;
  }
  return name;
}
INSTANTIATE_TEST_SUITE_P(Shelf, EveryCar, testing::ValuesIn(cars()), name_of);
// Without the slow tests: one that is hardly stable, one with steering that lags, and the smallest.
INSTANTIATE_TEST_SUITE_P(
    Shelf, LapsOf,
    testing::ValuesIn(kDrivesAll ? cars() : std::vector<std::string>{"bmw-320i", "f1tenth", "orca-1-43"}),
    name_of);

}  // namespace
}  // namespace chicane::run
