// SPDX-License-Identifier: MIT
#include "chicane/lap_time/limit.hpp"

#include "chicane/base/math.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"

namespace chicane::lap_time {
namespace {

/// A closed road with corners to both sides, one side wider than the other; `side` −1 mirrors it at the y
/// axis, along which the original's helper has its gap.
road::Track bean(double side = 1.0, double size = 1.0) { return test::bean_road(side, size, 4.0, 5.0); }

const PlantLimitOptions kCoarse{.time_step = 0.1};

const PlantLimit& limit_of(const std::string& car) {
  static const PlantLimit udacity = *find_plant_limit(bean(), "udacity", {}, kCoarse);
  static const PlantLimit road_car = *find_plant_limit(bean(), "road-car", {}, kCoarse);
  return car == "udacity" ? udacity : road_car;
}

class PlantLimitOf : public testing::TestWithParam<const char*> {};

TEST_P(PlantLimitOf, IsBracketedByALapThatWasDriven) {
  const PlantLimit& limit = limit_of(GetParam());
  ASSERT_TRUE(limit.witness);
  EXPECT_GE(limit.witness->laps, 3);
  EXPECT_GE(limit.witness->least_edge, 0.0);
  EXPECT_GE(limit.bracket(), 0.0);
  EXPECT_LE(limit.bracket(), 0.01);
}

/// Steps that go past the bounds would be halved, and cost time.
TEST_P(PlantLimitOf, IsFoundInFewSteps) {
  const bool is_udacity = GetParam() == std::string("udacity");
  EXPECT_GT(limit_of(GetParam()).of_optimum.iterations, 20);
  EXPECT_LE(limit_of(GetParam()).of_optimum.iterations, is_udacity ? 110 : 250);
}

TEST_P(PlantLimitOf, AMirroredRoadHasTheMirroredLine) {
  const PlantLimit& limit = limit_of(GetParam());
  const Result<PlantLimit> mirrored =
      find_plant_limit(bean(-1.0), GetParam(), {}, {.time_step = 0.1, .wants_witness = false});
  ASSERT_TRUE(mirrored) << mirrored.error().message;
  EXPECT_NEAR(mirrored->bound.lap / limit.bound.lap, 1.0, 5e-4);  // nodes lie elsewhere
  for (double s = 0.0; s < limit.line.length; s += 10.0)
    EXPECT_NEAR(mirrored->line.at(s).offset, -limit.line.at(s).offset, 0.25) << s;
}

TEST_P(PlantLimitOf, FinerNodesChangeLittle) {
  const Result<PlantLimit> finer =
      find_plant_limit(bean(), GetParam(), {}, {.time_step = 0.05, .wants_witness = false});
  ASSERT_TRUE(finer) << finer.error().message;
  EXPECT_NEAR(finer->bound.lap / limit_of(GetParam()).bound.lap, 1.0, 1e-3);  // second order in the spacing
}

TEST_P(PlantLimitOf, TheLineTellsTheMotionOfALap) {
  const PlantLimit& limit = limit_of(GetParam());
  EXPECT_EQ(limit.line.car, GetParam());
  EXPECT_EQ(limit.line.points.front().s, 0.0);
  EXPECT_EQ(limit.line.points.back().s, limit.line.length);
  EXPECT_NEAR(limit.line.lap_time(), limit.bound.lap, 1e-9);
  EXPECT_NEAR(limit.bound.sectors[0] + limit.bound.sectors[1] + limit.bound.sectors[2], limit.bound.lap,
              1e-9);
  for (std::size_t i = 1; i < limit.line.points.size(); ++i) {
    const road::RacingLinePoint& a = limit.line.points[i - 1];
    const road::RacingLinePoint& b = limit.line.points[i];
    ASSERT_NEAR(b.vx - a.vx, 0.5 * (a.acceleration + b.acceleration) * (b.time - a.time), 0.02)
        << a.s;  // the gap of the helper is not in `acceleration`
  }
}

TEST_P(PlantLimitOf, MoreGripIsFaster) {
  const Result<PlantLimit> better = find_plant_limit(bean(), GetParam(), {.friction_scale = 1.1},
                                                     {.time_step = 0.1, .wants_witness = false});
  ASSERT_TRUE(better) << better.error().message;
  EXPECT_LT(better->bound.lap, limit_of(GetParam()).bound.lap);
}

INSTANTIATE_TEST_SUITE_P(Plants, PlantLimitOf, testing::Values("udacity", "road-car"), [](const auto& param) {
  return std::string(param.param) == "udacity" ? "Udacity" : "RoadCar";
});

TEST(PlantLimit, ARoadShorterThanTheCarsTightestCircleIsRefused) {
  // A ring of 4 m, 1.3 m to each side.
  const road::Track track = test::circle_road(4.0, 60, 1.3, 1.3, {.spacing = 0.3, .smoothing_sigma = 0.0});
  const Result<PlantLimit> limit = find_plant_limit(track, "road-car");
  ASSERT_FALSE(limit);
  EXPECT_EQ(limit.error().code, ErrorCode::kInvalidArgument);
  EXPECT_NE(
      limit.error().message.find("the loop is 25.1 m long, expected more than the car's circle at full lock"),
      std::string::npos)
      << limit.error().message;
}

TEST(PlantLimit, ARoadNarrowerThanTheCarIsNamedWithItsPlace) {
  const Result<PlantLimit> limit = find_plant_limit(test::circle_road(60.0, 60, 0.8, 0.8, {}), "udacity");
  ASSERT_FALSE(limit);
  EXPECT_NE(limit.error().message.find("the road is 1.6"), std::string::npos) << limit.error().message;
}

TEST(PlantLimit, RefusesWhatItCannotAnswer) {
  std::vector<road::TrackPoint> straight;
  for (int i = 0; i < 20; ++i) straight.push_back({{10.0 * i, 0.0}, 4.0, 4.0});
  EXPECT_FALSE(find_plant_limit(*road::Track::create("open", straight, false), "udacity"));
  EXPECT_FALSE(find_plant_limit(bean(), "boat"));
  EXPECT_FALSE(find_plant_limit(bean(), "udacity", {}, {.time_step = 1.0}));
}

TEST(PlantLimit, CanBeStopped) {
  const Result<PlantLimit> limit = find_plant_limit(
      bean(), "udacity", {}, {.go_on = [](std::string_view, int i, double) { return i < 3; }});
  ASSERT_FALSE(limit);
  EXPECT_NE(limit.error().message.find("stopped"), std::string::npos);
}

}  // namespace
}  // namespace chicane::lap_time
