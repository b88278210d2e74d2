// SPDX-License-Identifier: MIT
#include "chicane/road/racing_road.hpp"

#include "chicane/base/math.hpp"
#include "chicane/road/known_road.hpp"
#include "road/sample_loop.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"

namespace chicane::road {
namespace {

constexpr double kBendRadius = 80.0;

/// A circle to the left (side 1) or right (-1), with 3 m of road inside and 5 m outside of it, faster in one
/// half.
std::vector<road::LinePoint> lap(double side) {
  std::vector<road::LinePoint> points;
  constexpr int kCount = 200;
  for (int i = 0; i <= kCount; ++i) {
    const double angle = kTwoPi * i / kCount;
    road::LinePoint point;
    point.position = {kBendRadius * std::sin(angle), side * kBendRadius * (1.0 - std::cos(angle))};
    point.heading = side * angle;
    point.curvature = side / kBendRadius;
    point.speed = 20.0 + 5.0 * std::sin(angle);
    point.left = side > 0.0 ? 3.0 : 5.0;
    point.right = side > 0.0 ? 5.0 : 3.0;
    points.push_back(point);
  }
  return points;
}

TEST(RacingRoad, HasTheLapsLineItsSpeedsAndItsRoom) {
  for (const double side : {1.0, -1.0}) {
    const RacingRoad road(lap(side), 0.5);
    ASSERT_TRUE(road.line().is_closed());
    EXPECT_NEAR(road.line().length(), kTwoPi * kBendRadius, 1e-3);
    EXPECT_LE(road.line().spacing(), RacingRoad::kSpacing);
    for (double s = -600.0; s < 1200.0; s += 31.7) {
      const double angle = s / kBendRadius;
      const CurvePoint at = road.line().at(s);
      EXPECT_NEAR(at.position.x(), kBendRadius * std::sin(angle), 1e-3);
      EXPECT_NEAR(at.position.y(), side * kBendRadius * (1.0 - std::cos(angle)), 1e-3);
      EXPECT_NEAR(at.curvature, side / kBendRadius, 1e-9);
      EXPECT_NEAR(road.line().demand(s).speed, 20.0 + 5.0 * std::sin(angle), 0.01);
      const Road::Room room = road.room(s);
      EXPECT_NEAR(side > 0.0 ? room.left : room.right, 3.5, 1e-9) << "the kerb is road";
      EXPECT_NEAR(side > 0.0 ? room.right : room.left, 5.5, 1e-9);
    }
  }
}

TEST(RacingRoad, StopsBeforeTheEndOfAnOpenRoad) {
  const RacingRoad road(lap(1.0), 0.0, {.is_closed = false, .braking = 4.0, .room_behind = 60.0});
  const double length = road.line().length();
  EXPECT_FALSE(road.line().is_closed());
  EXPECT_NEAR(road.line().demand(length - 12.0).speed, 0.0, 2.0);
  EXPECT_EQ(road.line().demand(length + 50.0).speed, 0.0);
  for (double s = 0.0; s < length - 14.0; s += 7.3) {
    const double planned = 20.0 + 5.0 * std::sin(s / kBendRadius);
    const double stops = std::sqrt(2.0 * 4.0 * (length - 12.0 - s));
    EXPECT_NEAR(road.line().demand(s).speed, std::min(planned, stops), 0.15) << s;
    EXPECT_GT(road.room(s).left, 2.9);
  }
  const RacingRoad bare(lap(1.0), 0.0, {.is_closed = false, .braking = 4.0, .room_behind = 0.0});
  EXPECT_NEAR(bare.line().demand(length - 2.0).speed, std::sqrt(2.0 * 4.0 * 4.0), 0.3) << "passes its finish";
  EXPECT_EQ(bare.line().demand(length).speed, 0.0);
  EXPECT_EQ(road.room(-10.0).left, road.room(0.0).left) << "nothing comes round again";
}

/// Laps on a circle of 8 m whose centre is 4 m beside that of the road, whose inner edge is one of 6 m.
/// `side`: 1 to the left, -1 mirrored.
TEST(RacingRoad, HasTheRoomAcrossItsLine) {
  for (const double side : {1.0, -1.0}) {
    std::vector<Vec2> circle = test::circle_points(12.0, 90);
    for (Vec2& point : circle) point.y() *= side;
    const Track track = *Track::create("circle", test::with_widths(circle, 6.0, 6.0), true);
    std::vector<LinePoint> lap(91);
    for (int i = 0; i <= 90; ++i) {
      const double angle = side * kTwoPi * i / 90.0;
      LinePoint& at = lap[static_cast<std::size_t>(i)];
      at.position = {4.0 + 8.0 * std::cos(angle), 8.0 * std::sin(angle)};
      at.heading = angle + side * 0.5 * kPi;
      at.curvature = side / 8.0;
      at.left = at.right = 20.0;
    }
    const RacingRoad road(lap, track, {.terms = {.slides = true}});
    const Road::Room room = road.room(0.25 * kTwoPi * 8.0);  // at (4, 8 side)
    EXPECT_NEAR(side > 0.0 ? room.left : room.right, 8.0 - std::sqrt(36.0 - 16.0), 0.05) << side;
    EXPECT_NEAR(side > 0.0 ? room.right : room.left, 18.0 - std::sqrt(80.0), 0.05) << "far off";
  }
}

TEST(RacingRoad, IsEmptyForNoLap) {
  EXPECT_TRUE(RacingRoad({}).line().is_empty());
  const std::vector<road::LinePoint> few(4);
  EXPECT_TRUE(RacingRoad(few).line().is_empty());
}

TEST(RacingRoad, IsWhatAStopOnItFollows) {
  const RacingRoad road(lap(1.0));
  KnownRoad known(4.0, model::udacity_params());
  known.use_line(nullptr);
  EXPECT_TRUE(known.line().is_empty());
  road::RoadData data;
  data.length = 100.0;
  data.points = {{.s = 0.0, .left = 4.0, .right = 4.0},
                 {.s = 100.0, .position = {100.0, 0.0}, .left = 4.0, .right = 4.0}};
  KnownRoad told(data, model::udacity_params());
  const unsigned before = told.revision();
  EXPECT_EQ(told.target({.left = 5.0, .right = 3.0}, 1.5), 1.0) << "the middle of the road";
  told.use_line(&road);
  EXPECT_NE(told.revision(), before);
  EXPECT_NEAR(told.line().length(), kTwoPi * kBendRadius, 1e-3);
  EXPECT_NEAR(told.edges(10.0).left, 3.0, 1e-9);
  EXPECT_EQ(told.target({.left = 5.0, .right = 3.0}, 1.5), 0.0) << "the line itself";
  EXPECT_EQ(told.target({.left = 7.0, .right = 1.0}, 1.5), 0.5) << "but away from the edge";
  EXPECT_EQ(told.target({.left = 1.0, .right = 7.0}, 1.5), -0.5);
}

// The waypoints' own line has been given up for one that runs 1 m to its left: as much less road on that
// side.
TEST(KnownRoadFromWaypoints, TakesALearnedLapUntilItsWaypointsAreForgotten) {
  std::vector<road::LinePoint> points = lap(1.0);
  for (road::LinePoint& point : points) point.d = 1.0;
  const RacingRoad learned(points, 0.0, {.is_learned = true});
  KnownRoad road(3.5, model::udacity_params());
  const unsigned before = road.revision();
  road.use_line(&learned);
  EXPECT_TRUE(road.is_raced());
  EXPECT_NE(road.revision(), before);
  ASSERT_TRUE(road.line().is_closed());
  for (double s = 0.0; s < 500.0; s += 50.0) {
    EXPECT_NEAR(road.edges(s).left, 2.5, 1e-9) << s;
    EXPECT_NEAR(road.edges(s).right, 4.5, 1e-9) << s;
  }
  const unsigned raced = road.revision();
  road.reset();
  EXPECT_FALSE(road.is_raced());
  EXPECT_NE(road.revision(), raced);
  EXPECT_TRUE(road.line().is_empty());
}

std::shared_ptr<const RacingRoad> raced_lap(bool is_learned) {
  return std::make_shared<const RacingRoad>(lap(1.0), 0.0, RacingRoad::Basis{.is_learned = is_learned});
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
  road.race_by(raced_lap(true));
  EXPECT_TRUE(road.is_raced());
  EXPECT_NE(road.revision(), before);
  EXPECT_NEAR(road.line().length(), kTwoPi * kBendRadius, 0.1);
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
  road.race_by(raced_lap(true));
  EXPECT_TRUE(road.add(seeing(points, 7)));
  EXPECT_TRUE(road.is_raced());
  EXPECT_FALSE(road.add(seeing(elsewhere, 7)));
  EXPECT_FALSE(road.is_raced());
  learn(road, elsewhere);
  road.race_by(raced_lap(true));
  road.reset();
  EXPECT_FALSE(road.is_raced());
  EXPECT_TRUE(road.line().is_empty());
}

TEST(DrivenRoad, KeepsALapOfATrackThatItWasTold) {
  DrivenRoad road({}, model::udacity_params());
  road.race_by(raced_lap(false));
  EXPECT_TRUE(road.add(seeing(stadium(), 0)));
  EXPECT_TRUE(road.seen().line().is_empty()) << "waypoints tell nothing then";
  road.reset();
  EXPECT_TRUE(road.is_raced());
}

}  // namespace
}  // namespace chicane::road
