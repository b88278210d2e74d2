// SPDX-License-Identifier: MIT
#include "chicane/sim/range_scanner.hpp"

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
  auto scanner = RangeScanner::create(test::straight_road(10, 2.0, 3.0, {}),
                                      {.beams = 3, .field_of_view = 3.14159265358979});
  ASSERT_TRUE(scanner);
  std::vector<float> ranges(3);
  scanner->scan({.x = 50.0, .y = 0.5, .psi = 0.0}, ranges);
  EXPECT_NEAR(ranges[0], 3.5F, 1e-4F);
  EXPECT_TRUE(std::isinf(ranges[1]));
  EXPECT_NEAR(ranges[2], 1.5F, 1e-4F);
  scanner->scan({.x = 50.0, .y = 0.5, .psi = 3.0}, ranges);  // across the direction where angles wrap
  EXPECT_NEAR(ranges[0], static_cast<float>(1.5 / std::cos(3.0 - 3.14159265)), 1e-3F);
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

}  // namespace
}  // namespace chicane::sim
