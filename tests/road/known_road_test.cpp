// SPDX-License-Identifier: MIT
#include "chicane/road/known_road.hpp"

#include "chicane/road/racing_road.hpp"

#include "road/sample_loop.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"
#include "support/stadium.hpp"

namespace chicane::road {
namespace {

TEST(KnownRoad, KnowsATracksEdgesFromTheBeginning) {
  const KnownRoad road(road_data(test::circle_road(100.0, 200, 4.0, 6.0), 2.0), model::udacity_params());
  ASSERT_TRUE(road.line().is_closed());
  EXPECT_NEAR(road.line().length(), kTwoPi * 100.0, 10.0);
  for (double s = -300.0; s < 1000.0; s += 37.0) {
    const CurvePoint at = road.line().at(s);
    const double radius = at.position.norm();
    const KnownRoad::Edges edges = road.edges(s);
    EXPECT_NEAR(radius - edges.left, 96.0, 0.05)
        << s << ": the edge stays where it is, wherever the line runs";
    EXPECT_NEAR(radius + edges.right, 106.0, 0.05) << s;
    EXPECT_NEAR(at.curvature, 0.01, 2e-3);
  }
}

/// Across the smooth line, which cuts bends, the edges are where the track has them.
TEST(KnownRoad, HasTheEdgesOfBendsThatItsLineCuts) {
  constexpr double kStraight = 60.0, kRadius = 14.0, kWidth = 4.0;
  for (const double side : {1.0, -1.0}) {
    road::RoadData data;
    data.is_closed = true;
    data.length = 2.0 * (kStraight + kPi * kRadius);
    const int count = static_cast<int>(data.length);
    for (int i = 0; i <= count; ++i) {
      const double s = data.length * i / count;
      const auto [at, heading, curvature] = test::stadium_place(s, kRadius, kStraight);
      data.points.push_back({.s = s,
                             .position = {at.x(), side * at.y()},
                             .heading = side * heading,
                             .curvature = side * curvature,
                             .left = kWidth,
                             .right = kWidth});
    }
    const KnownRoad road(data, model::udacity_params());
    ASSERT_TRUE(road.line().is_closed());
    double worst = 0.0;
    for (double s = 0.0; s < road.line().length(); s += 1.0) {
      const CurvePoint at = road.line().at(s);
      const Vec2 left{-at.tangent.y(), at.tangent.x()};
      for (const double way : {road.edges(s).left, -road.edges(s).right}) {
        const Vec2 edge = at.position + way * left;
        const double x = std::clamp(edge.x(), 0.0, kStraight);
        const double off = (edge - Vec2{x, side * kRadius}).norm();
        worst = std::max(worst, std::fabs(std::fabs(off - kRadius) - kWidth));
      }
    }
    EXPECT_LT(worst, 0.03);
  }
}

TEST(KnownRoad, KeepsAnOpenTracksOwnLine) {
  road::RoadData data;
  data.length = 100.0;
  for (int i = 0; i <= 50; ++i)
    data.points.push_back({.s = 2.0 * i, .position = {2.0 * i, 0.0}, .left = 3.0 + 0.02 * i, .right = 5.0});
  const KnownRoad road(data, model::udacity_params());
  EXPECT_FALSE(road.line().is_closed());
  EXPECT_NEAR(road.edges(51.0).left, 3.51, 1e-9);
  EXPECT_NEAR(road.edges(500.0).left, 4.0, 1e-9) << "beyond the end as at the end";
  EXPECT_EQ(road.end(), road.line().length());
}

TEST(KnownRoad, GoesOnToWhereTheNextWaypointWouldBe) {
  for (const double apart : {8.0, 20.0, 60.0}) {
    KnownRoad road(3.5, model::udacity_params());
    model::Measurement now;
    now.waypoint_count = 6;
    for (std::size_t i = 0; i < 6; ++i) now.waypoints[i] = {apart * static_cast<double>(i), 0.0};
    road.add(now);
    ASSERT_FALSE(road.line().is_empty());
    const double beyond = road.end() - road.line().length();
    EXPECT_NEAR(beyond, std::min(apart, 25.0) + 3.5, 1e-9) << apart;
    now.time = 0.3;
    now.waypoints[5] = {std::nan(""), 0.0};
    road.add(now);
    EXPECT_NEAR(road.end() - road.line().length(), beyond, 1e-9) << "a waypoint that is no number";
  }
}

TEST(KnownRoad, LearnsFromWaypointsWhatItIsNotTold) {
  KnownRoad road(3.5, model::udacity_params());
  EXPECT_TRUE(road.line().is_empty());
  const std::vector<Vec2> points = stadium();
  const unsigned before = road.revision();
  model::Measurement now = seeing(points, 0);
  road.add(now);
  ASSERT_FALSE(road.line().is_empty());
  EXPECT_NE(road.revision(), before);
  for (int i = 1; i < 200; ++i) {
    now = seeing(points, i);
    now.time = 0.3 * i;
    road.add(now);
  }
  ASSERT_TRUE(road.line().is_closed());
  const KnownRoad::Edges edges = road.edges(100.0);
  EXPECT_NEAR(edges.left + edges.right, 7.0, 1e-9);
  road.reset();
  EXPECT_TRUE(road.line().is_empty());
}

}  // namespace
}  // namespace chicane::road
