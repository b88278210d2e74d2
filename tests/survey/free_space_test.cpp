// SPDX-License-Identifier: MIT
#include "chicane/survey/free_space.hpp"

#include "chicane/base/math.hpp"
#include "support/chicane_test.hpp"

namespace chicane::survey {
namespace {

using ::testing::AllOf;

/// A square of unknown cells, 12 m wide, with a ring of free ones of radius 4 m round its middle between
/// walls.
FreeSpace ring(double width, double cell = 0.05) {
  const int side = static_cast<int>(12.0 / cell);
  FreeSpace space{.width = side, .height = side, .resolution = cell, .origin = {-6.0, -6.0}};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double away = std::fabs(std::hypot((x + 0.5) * cell - 6.0, (y + 0.5) * cell - 6.0) - 4.0);
      space.cells.push_back(away < 0.5 * width          ? Cell::kFree
                            : away < 0.5 * width + 0.12 ? Cell::kWall
                                                        : Cell::kUnknown);
    }
  return space;
}

/// Makes the cells whose middle in W is meant something else.
template <class IsMeant>
void paint(FreeSpace& space, Cell cell, const IsMeant& is_meant) {
  for (int i = 0; i < space.width * space.height; ++i)
    if (is_meant(space.to_world({i % space.width + 0.5, i / space.width + 0.5})))
      space.cells[static_cast<std::size_t>(i)] = cell;
}

/// Those of a rectangle.
void paint(FreeSpace& space, const Vec2& low, const Vec2& high, Cell cell) {
  paint(space, cell, [&](const Vec2& place) {
    return place.x() > low.x() && place.x() < high.x() && place.y() > low.y() && place.y() < high.y();
  });
}
void expect_ring(const FreeLoop& loop, double width, double tolerance) {
  ASSERT_GT(loop.points.size(), 30U);
  double turned = 0.0;
  for (std::size_t i = 0; i < loop.points.size(); ++i) {
    const road::TrackPoint& point = loop.points[i];
    EXPECT_NEAR(point.position.norm(), 4.0, tolerance);
    EXPECT_NEAR(point.left + point.right, width - tolerance, 2.0 * tolerance);
    const Vec2& next = loop.points[(i + 1) % loop.points.size()].position;
    turned +=
        angle_difference(std::atan2(next.y(), next.x()), std::atan2(point.position.y(), point.position.x()));
  }
  EXPECT_NEAR(turned, kTwoPi, 1e-6) << "once round, counter-clockwise";
}

TEST(FreeSpace, TheLoopIsInTheMiddleOfTheRing) {
  // Edges are known to a cell.
  for (const double width : {1.0, 2.4}) {
    const auto loop = test::good(find_loop(ring(width), {}));
    expect_ring(*loop, width, 0.05);
    EXPECT_NEAR(loop->median_width, width - 0.05, 0.06) << "between the tips of the cells";
  }
}

/// By how much more a road widens where its outer wall begins to step back, at `angle` [rad], than where that
/// ends: in the first half of what is wider against the second half [m].
double lead_of_a_bay(double angle) {
  FreeSpace space = ring(2.4);
  paint(space, Cell::kFree, [&](const Vec2& place) {
    const double beside = angle_difference(std::atan2(place.y(), place.x()), angle);
    return place.norm() > 5.1 && place.norm() < 5.7 && std::fabs(beside) < 0.24;
  });
  const FreeLoop loop = *find_loop(space, {});
  const std::size_t count = loop.points.size();
  const auto is_opposite = [&](const road::TrackPoint& point) {
    return std::fabs(angle_difference(std::atan2(point.position.y(), point.position.x()), angle)) > 2.5;
  };
  std::size_t first = 0;
  while (!is_opposite(loop.points[first])) ++first;
  std::vector<double> wider;
  for (std::size_t i = 0; i < count; ++i) {
    const road::TrackPoint& point = loop.points[(first + i) % count];
    if (const double by = point.left + point.right - loop.median_width; by > 0.06) wider.push_back(by);
  }
  EXPECT_GE(wider.size(), 4U);
  const auto half = static_cast<std::ptrdiff_t>(wider.size() / 2);
  return std::accumulate(wider.begin(), wider.begin() + half, 0.0) -
         std::accumulate(wider.end() - half, wider.end(), 0.0);
}

TEST(FreeSpace, TheRoadWidensAsItNarrowsAlongABay) {
  double sum = 0.0;  // over where the first cell and the first point may lie
  for (int i = 0; i < 16; ++i) sum += lead_of_a_bay(0.1 + 0.37 * i);
  EXPECT_NEAR(sum / 16.0, 0.0, 0.02);
}

TEST(FreeSpace, CoarseAndFineCellsAndATurnedMapGiveTheSameRoad) {
  const auto coarse = test::good(find_loop(ring(2.0, 0.1), {}));
  expect_ring(*coarse, 2.0, 0.1);
  FreeSpace turned = ring(2.0, 0.05);
  turned.yaw = 0.7;
  turned.origin = turned.origin - (turned.to_world(turned.to_cells({0.0, 0.0})) - Vec2{0.0, 0.0});
  const Vec2 middle = turned.to_world({0.5 * turned.width, 0.5 * turned.height});
  turned.origin -= middle;
  const auto other = test::good(find_loop(turned, {}));
  expect_ring(*other, 2.0, 0.05);
}

TEST(FreeSpace, SmallSpotsOnTheRoadAreNoiseAndSaidSo) {
  FreeSpace space = ring(2.0);
  paint(space, {3.9, -0.1}, {4.0, 0.0}, Cell::kWall);
  paint(space, {-4.1, 0.2}, {-4.0, 0.3}, Cell::kUnknown);
  const auto loop = test::good(find_loop(space, {}));
  EXPECT_EQ(loop->spots, 2);
  expect_ring(*loop, 2.0, 0.05);
}

TEST(FreeSpace, AStartChoosesAmongSeveralRoads) {
  FreeSpace space = ring(1.0);
  // A smaller ring in the infield of the large one.
  paint(space, Cell::kFree, [](const Vec2& place) { return place.norm() > 1.0 && place.norm() < 2.0; });
  EXPECT_NEAR(find_loop(space, {})->points.front().position.norm(), 4.0, 0.1);
  EXPECT_NEAR(find_loop(space, {.start = Vec2{1.5, 0.0}})->points.front().position.norm(), 1.5, 0.1);
  EXPECT_THAT(find_loop(space, {.start = Vec2{0.0, 0.0}}).error().message,
              HasSubstr("start: got (0, 0), expected a place in free space"));
}

TEST(FreeSpace, SaysWhereARoadIsOpen) {
  FreeSpace wall = ring(1.0);
  paint(wall, {-0.2, 3.0}, {0.2, 5.0}, Cell::kWall);
  const std::string shut = find_loop(wall, {}).error().message;
  EXPECT_THAT(shut, AllOf(HasSubstr("free space: got no loop, open between ("), Not(HasSubstr("unknown"))));
  FreeSpace unseen = ring(1.0);
  paint(unseen, {-0.5, -5.0}, {0.5, -3.0}, Cell::kUnknown);
  const std::string hidden = find_loop(unseen, {}).error().message;
  EXPECT_THAT(hidden, HasSubstr("m apart, where cells are unknown; expected a closed loop"));
  Vec2 one{9.0, 9.0}, other = one;
  ASSERT_EQ(std::sscanf(hidden.c_str() + hidden.find('('), "(%lf, %lf) and (%lf, %lf)", &one.x(), &one.y(),
                        &other.x(), &other.y()),
            4)
      << hidden;
  for (const Vec2& end : {one, other}) EXPECT_NEAR((end - Vec2{0.0, -4.0}).norm(), 0.75, 0.35) << hidden;
  FreeSpace tight = ring(1.0);
  paint(tight, {4.05, -0.3}, {5.0, 0.3}, Cell::kWall);
  paint(tight, {3.0, -0.3}, {3.8, 0.3}, Cell::kWall);
  EXPECT_THAT(find_loop(tight, {}).error().message, HasSubstr("m wide at (3.9"));
  EXPECT_TRUE(find_loop(tight, {.least_width = 0.15}));
}

TEST(FreeSpace, RoomWithoutAnythingInItIsNoLoop) {
  FreeSpace room{
      .width = 100, .height = 100, .resolution = 0.05, .cells = std::vector<Cell>(10000, Cell::kFree)};
  EXPECT_THAT(find_loop(room, {}).error().message, HasSubstr("got no loop"));
  std::fill(room.cells.begin(), room.cells.end(), Cell::kUnknown);
  EXPECT_THAT(find_loop(room, {}).error().message, HasSubstr("free space: got no"));
}

}  // namespace
}  // namespace chicane::survey
