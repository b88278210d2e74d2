// SPDX-License-Identifier: MIT
#include "chicane/road/racing_road.hpp"

#include "road/sample_loop.hpp"
#include "support/chicane_test.hpp"

namespace chicane::road {
namespace {

std::shared_ptr<const RacingRoad> lap(bool is_learned) {
  std::vector<road::LinePoint> points;
  for (int i = 0; i <= 100; ++i) {
    const double angle = kTwoPi * i / 100.0;
    road::LinePoint point;
    point.position = {80.0 * std::cos(angle), 80.0 * std::sin(angle)};
    point.heading = angle + 0.5 * kPi;
    point.curvature = 1.0 / 80.0;
    points.push_back(point);
  }
  return std::make_shared<const RacingRoad>(points, 0.0, RacingRoad::Basis{.is_learned = is_learned});
}

/// Drives round until the loop is closed and its lap is planned.
void learn(DrivenRoad& road, const std::vector<Vec2>& points) {
  for (int i = 0; i < 2000 && road.seen().closed_waypoints().empty(); ++i)
    EXPECT_TRUE(road.add(seeing(points, i < 60 ? i : i / 8)));
  ASSERT_EQ(road.seen().closed_waypoints().size(), points.size());
}

TEST(DrivenRoad, IsWhatWaypointsShowUntilALapIsRacedBy) {
  DrivenRoad road({}, model::udacity_params());
  EXPECT_TRUE(road.line().is_empty());
  learn(road, stadium());
  EXPECT_NEAR(road.line().length(), road.seen().line().length(), 1e-12);
  const unsigned before = road.revision();
  road.race_by(lap(true));
  EXPECT_TRUE(road.is_raced());
  EXPECT_NE(road.revision(), before);
  EXPECT_NEAR(road.line().length(), kTwoPi * 80.0, 0.1);
  road.race_by(nullptr);
  EXPECT_FALSE(road.is_raced());
  EXPECT_NEAR(road.line().length(), road.seen().line().length(), 1e-12);
}

TEST(DrivenRoad, GivesUpALearnedLapWithTheWaypointsItWasMadeOf) {
  DrivenRoad road({}, model::udacity_params());
  const std::vector<Vec2> points = stadium();
  std::vector<Vec2> elsewhere = points;
  for (Vec2& point : elsewhere) point += Vec2{1000.0, 0.0};
  learn(road, points);
  road.race_by(lap(true));
  EXPECT_TRUE(road.add(seeing(points, 7)));
  EXPECT_TRUE(road.is_raced());
  EXPECT_FALSE(road.add(seeing(elsewhere, 7)));
  EXPECT_FALSE(road.is_raced());
  learn(road, elsewhere);
  road.race_by(lap(true));
  road.reset();
  EXPECT_FALSE(road.is_raced());
  EXPECT_TRUE(road.line().is_empty());
}

TEST(DrivenRoad, KeepsALapOfATrackThatItWasTold) {
  DrivenRoad road({}, model::udacity_params());
  road.race_by(lap(false));
  EXPECT_TRUE(road.add(seeing(stadium(), 0)));
  EXPECT_TRUE(road.seen().line().is_empty()) << "waypoints tell nothing then";
  road.reset();
  EXPECT_TRUE(road.is_raced());
}

}  // namespace
}  // namespace chicane::road
