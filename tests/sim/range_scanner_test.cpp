// SPDX-License-Identifier: MIT
#include "chicane/sim/range_scanner.hpp"

#include "chicane/base/math.hpp"
#include "chicane/base/random.hpp"
#include "chicane/protocol/track_codec.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"

namespace chicane::sim {
namespace {

road::Track track_of(const std::string& name, double scale) {
  auto track = protocol::read_track(std::string(CHICANE_SOURCE_DIR) + "/data/tracks/" + name + ".csv");
  EXPECT_TRUE(track);
  return scale == 1.0 ? std::move(*track) : track->scaled(scale);
}

/// Where a beam leaves the road, by the road's own geometry: marched in steps, then halved.
double range_by_geometry(const road::Track& track, const Vec2& from, double angle, double longest) {
  const Vec2 direction{std::cos(angle), std::sin(angle)};
  const auto inside = [&](double t) {
    return track.edge_distance(track.centre().project(from + t * direction)) + track.kerb_width() > 0.0;
  };
  constexpr double kStep = 0.02;
  double t = 0.0;
  while (t < longest && inside(t + kStep)) t += kStep;
  if (t >= longest) return std::numeric_limits<double>::infinity();
  double outside = t + kStep;
  for (int i = 0; i < 30; ++i) (inside(0.5 * (t + outside)) ? t : outside) = 0.5 * (t + outside);
  return t;
}

struct Errors {
  int compared = 0;
  double worst = 0.0;  // [m]
};

/// Random poses on the road, one beam of each in a random direction.
Errors compare(const road::Track& track, int poses) {
  auto scanner = RangeScanner::create(track);
  EXPECT_TRUE(scanner);
  std::vector<float> ranges(1080);
  Random random(7);
  Errors errors;
  while (errors.compared < poses) {
    const double s = random.uniform() * track.length();
    const road::PathPoint at = track.centre().at(s);
    const double d = (2.0 * random.uniform() - 1.0) * 0.8;
    const Vec2 normal{-std::sin(at.heading), std::cos(at.heading)};
    const Vec2 here = at.position + d * (d > 0 ? track.left_width(s) : track.right_width(s)) * normal;
    const model::Pose pose{.x = here.x(), .y = here.y(), .psi = 6.28 * random.uniform()};
    scanner->scan(pose, ranges);
    const auto beam = static_cast<std::size_t>(random.uniform() * 1079.0);
    const double angle = pose.psi + scanner->first_angle() + static_cast<double>(beam) * scanner->increment();
    const double expected = range_by_geometry(track, here, angle, 29.9);
    if (!std::isfinite(expected)) continue;
    ++errors.compared;
    errors.worst = std::max(errors.worst, std::fabs(static_cast<double>(ranges[beam]) - expected));
  }
  return errors;
}

TEST(RangeScanner, AgreesWithTheRoadsGeometryWithinOneCentimetre) {
  const Errors errors = compare(track_of("oval", 0.1), 1000);
  RecordProperty("worst_mm", std::to_string(1e3 * errors.worst));
  EXPECT_LE(errors.worst, 0.01);
}

TEST(RangeScanner, SeesAStraightWallWhereItIs) {
  auto scanner =
      RangeScanner::create(test::straight_road(10, 2.0, 3.0, {}), {.beams = 3, .field_of_view = kPi});
  ASSERT_TRUE(scanner);
  std::vector<float> ranges(3);
  scanner->scan({.x = 50.0, .y = 0.5, .psi = 0.0}, ranges);
  EXPECT_NEAR(ranges[0], 3.5F, 1e-4F);
  EXPECT_TRUE(std::isinf(ranges[1]));
  EXPECT_NEAR(ranges[2], 1.5F, 1e-4F);
  scanner->scan({.x = 50.0, .y = 0.5, .psi = 3.0}, ranges);  // across the direction where angles wrap
  EXPECT_NEAR(ranges[0], static_cast<float>(1.5 / std::cos(3.0 - kPi)), 1e-3F);
}

TEST(RangeScanner, ACrossingIsOpen) {
  const road::Track track = track_of("crossover", 1.0);
  ASSERT_EQ(track.crossings(), 1);
  const Errors errors = compare(track, 300);
  EXPECT_LE(errors.worst, 0.5);  // but for the corners of the crossing, which are rounded
}

TEST(RangeScanner, RefusesOptionsOutOfRange) {
  EXPECT_FALSE(RangeScanner::create(track_of("oval", 0.1), {.beams = 1}));
  EXPECT_FALSE(RangeScanner::create(track_of("oval", 0.1), {.range_max = 0.0}));
}

/// A room of 40 m by 30 m, turned, with walls around it and posts within.
OccupancyGrid room_with_posts(Random& random) {
  OccupancyGrid grid{.width = 800,
                     .height = 600,
                     .resolution = 0.05,
                     .origin = {.x = -12.0, .y = 7.0, .psi = 0.4},
                     .is_wall = std::vector<bool>(800 * 600)};
  const auto fill = [&](int left, int right, int low, int high) {
    for (int y = low; y < high; ++y)
      for (int x = left; x < right; ++x) grid.is_wall[static_cast<std::size_t>(y * 800 + x)] = true;
  };
  fill(0, 800, 0, 2);
  fill(0, 800, 598, 600);
  fill(0, 2, 0, 600);
  fill(798, 800, 100, 600);  // below is a gap, through which beams leave the map
  for (int i = 0; i < 60; ++i) {
    const int x = static_cast<int>(random.uniform() * 780), y = static_cast<int>(random.uniform() * 580);
    fill(x, x + 1 + i % 12, y, y + 1 + i % 7);
  }
  return grid;
}

/// The distance to the nearest cell that is wall by meeting the sides of each, and nothing clever.
double range_by_geometry(const OccupancyGrid& grid, const std::vector<int>& walls, const Vec2& from,
                         double angle, double longest) {
  const double c = std::cos(grid.origin.psi), s = std::sin(grid.origin.psi);
  const double dx = from.x() - grid.origin.x, dy = from.y() - grid.origin.y;
  const double px = c * dx + s * dy, py = c * dy - s * dx;
  const double ux = std::cos(angle - grid.origin.psi), uy = std::sin(angle - grid.origin.psi);
  double best = std::numeric_limits<double>::infinity();
  for (const int wall : walls) {
    const int x = wall % grid.width, y = wall / grid.width;
    const double r = grid.resolution;
    const double x1 = (x * r - px) / ux, x2 = ((x + 1) * r - px) / ux;
    const double y1 = (y * r - py) / uy, y2 = ((y + 1) * r - py) / uy;
    const double begin = std::max(std::min(x1, x2), std::min(y1, y2));
    const double end = std::min(std::max(x1, x2), std::max(y1, y2));
    if (end >= std::max(begin, 0.0)) best = std::min(best, std::max(begin, 0.0));
  }
  return best <= longest ? best : std::numeric_limits<double>::infinity();
}

TEST(MapScanner, AgreesWithGeometryWithinOneCentimetreAtAThousandPoses) {
  Random random(11);
  const OccupancyGrid grid = room_with_posts(random);
  auto scanner = test::good(MapScanner::create(grid));
  std::vector<float> ranges(1080);
  std::vector<int> walls;
  for (int i = 0; i < grid.width * grid.height; ++i)
    if (grid.is_wall[static_cast<std::size_t>(i)]) walls.push_back(i);
  double worst = 0.0;
  int infinite = 0;
  for (int i = 0; i < 1000; ++i) {
    const double x = 40.0 * random.uniform(), y = 30.0 * random.uniform();
    const double c = std::cos(grid.origin.psi), s = std::sin(grid.origin.psi);
    const model::Pose pose{.x = grid.origin.x + c * x - s * y,
                           .y = grid.origin.y + s * x + c * y,
                           .psi = 2.0 * kPi * random.uniform()};
    scanner->scan(pose, ranges);
    const auto beam = static_cast<std::size_t>(random.uniform() * 1079.0);
    const RangeScannerOptions& options = scanner->options();
    const double angle = pose.psi + options.first_angle() + static_cast<double>(beam) * options.increment();
    const double expected = range_by_geometry(grid, walls, {pose.x, pose.y}, angle, options.range_max);
    const auto seen = static_cast<double>(ranges[beam]);
    ASSERT_EQ(std::isinf(seen), std::isinf(expected)) << "pose " << i << ": " << seen << ", " << expected;
    if (std::isinf(seen)) {
      ++infinite;
    } else {
      worst = std::max(worst, std::fabs(seen - expected));
    }
  }
  RecordProperty("worst_mm", std::to_string(1e3 * worst));
  EXPECT_LE(worst, 1e-4);  // the promise is 1 cm; a float at 30 m has 2e-6 m
  EXPECT_GT(infinite, 0) << "some beams leave the map or end before the wall";
}

TEST(MapScanner, SeesAlongTheAxesAndFromOutside) {
  OccupancyGrid grid{
      .width = 10, .height = 3, .resolution = 0.5, .origin = {}, .is_wall = std::vector<bool>(30)};
  grid.is_wall[1 * 10 + 8] = true;  // 4.0 to 4.5 m, 0.5 to 1.0 m
  auto scanner = test::good(MapScanner::create(grid, {.beams = 3, .field_of_view = kPi}));
  std::vector<float> ranges(3);
  scanner->scan({.x = 1.0, .y = 0.75, .psi = 0.0}, ranges);
  EXPECT_FLOAT_EQ(ranges[1], 3.0F);
  EXPECT_TRUE(std::isinf(ranges[0]));
  scanner->scan({.x = -2.0, .y = 0.75, .psi = 0.0}, ranges);
  EXPECT_FLOAT_EQ(ranges[1], 6.0F);
  scanner->scan({.x = -2.0, .y = 0.75, .psi = kPi}, ranges);
  EXPECT_TRUE(std::isinf(ranges[1]));
  scanner->scan({.x = 4.25, .y = 0.75, .psi = 0.0}, ranges);
  EXPECT_EQ(ranges[1], 0.0F);
  EXPECT_TRUE(scanner->is_wall({4.25, 0.75}));
  EXPECT_FALSE(scanner->is_wall({3.9, 0.75}));
  EXPECT_FALSE(scanner->is_wall({-1.0, 0.75}));
}

TEST(MapScanner, RefusesGridsAndOptionsThatDoNotFit) {
  const OccupancyGrid sound{
      .width = 2, .height = 2, .resolution = 0.5, .origin = {}, .is_wall = std::vector<bool>(4)};
  ASSERT_TRUE(MapScanner::create(sound));
  OccupancyGrid other = sound;
  other.height = 3;
  EXPECT_FALSE(MapScanner::create(other));
  other = sound;
  other.resolution = 0.0;
  EXPECT_FALSE(MapScanner::create(other));
  EXPECT_FALSE(MapScanner::create(sound, {.beams = 1}));
}

}  // namespace
}  // namespace chicane::sim
