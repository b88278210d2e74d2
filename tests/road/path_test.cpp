// SPDX-License-Identifier: MIT
#include "chicane/road/path.hpp"

#include "chicane/base/math.hpp"
#include "chicane/base/random.hpp"
#include "support/alloc_guard.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"

namespace chicane::road {
namespace {

using test::circle_points;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A smooth closed loop with left and right turns, points unevenly spaced by up to 3 : 1.
std::vector<Vec2> wavy_loop(std::uint64_t seed, int count = 90) {
  Random random{seed};
  const double amplitude = random.uniform(10.0, 30.0);
  const double phase = random.uniform(0.0, kTwoPi);
  const int waves = 2 + static_cast<int>(random.bits() % 3U);
  std::vector<Vec2> points;
  double angle = 0.0;
  while (angle < kTwoPi * (1.0 - 0.6 / count)) {
    const double radius = 150.0 + amplitude * std::sin(waves * angle + phase);
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    angle += kTwoPi / count * random.uniform(0.5, 1.5);
  }
  return points;
}

Vec2 offset_point(const Path& path, double s, double d) {
  const PathPoint p = path.at(s);
  return p.position + d * Vec2{-std::sin(p.heading), std::cos(p.heading)};
}

TEST(Path, CircleHasItsLengthHeadingAndCurvature) {
  const Path path = Path::create(circle_points(50.0, 60), true).value();
  // 60 points: a turn of 0.105 rad per segment, the interpolation error is of order 0.105⁴/384.
  EXPECT_NEAR(path.length(), kTwoPi * 50.0, 1e-3);
  EXPECT_DOUBLE_EQ(path.turning(), kTwoPi);
  for (double s = -100.0; s < 500.0; s += 7.3) {
    const PathPoint p = path.at(s);
    EXPECT_NEAR(p.position.norm(), 50.0, 1e-4);
    EXPECT_NEAR(p.curvature, 0.02, 2e-5);
    EXPECT_NEAR(p.heading, kPi / 2.0 + s / 50.0, 1e-4) << "continuous also beyond one lap, s = " << s;
  }
}

TEST(Path, PassesThroughItsPointsInOrder) {
  const std::vector<Vec2> points = wavy_loop(3);
  const Path path = Path::create(points, true).value();
  double before = -1.0;
  for (const Vec2& point : points) {
    const Projection foot = path.project(point);
    EXPECT_LT(foot.distance, 1e-9);
    EXPECT_GT(foot.s, before);
    before = foot.s;
  }
}

TEST(Path, ParameterIsArcLengthAndDerivativesAgreeWithDifferences) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Path path = Path::create(wavy_loop(seed), true).value();
    const double step = 1e-4;
    for (double s = 0.37; s < path.length(); s += 3.1) {
      const PathPoint a = path.at(s - step);
      const PathPoint p = path.at(s);
      const PathPoint b = path.at(s + step);
      EXPECT_NEAR((b.position - a.position).norm() / (2.0 * step), 1.0, 1e-3);
      EXPECT_NEAR((b.heading - a.heading) / (b.position - a.position).norm(), p.curvature, 1e-5);
      // Curvature slope jumps at the points; away from them it is the difference quotient.
      const double slope = (b.curvature - a.curvature) / (b.position - a.position).norm();
      if (std::fabs(a.curvature_slope - b.curvature_slope) < 1e-4) {
        EXPECT_NEAR(slope, p.curvature_slope, 2e-4);
      }
    }
  }
}

TEST(Path, ProjectionInvertsEvaluation) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const Path path = Path::create(wavy_loop(seed), true).value();
    Random random{seed};
    for (int k = 0; k < 200; ++k) {
      const double s = random.uniform(0.0, path.length());
      const double d = random.uniform(-6.0, 6.0);
      const Vec2 point = offset_point(path, s, d);
      const Projection whole = path.project(point);
      EXPECT_NEAR(path.difference(whole.s, s), 0.0, 1e-7);
      EXPECT_NEAR(whole.d, d, 1e-8);
      const Projection warm = path.project(point, s + random.uniform(-15.0, 15.0), 20.0);
      EXPECT_NEAR(path.difference(warm.s, s), 0.0, 1e-7);
      EXPECT_NEAR(warm.distance, std::fabs(d), 1e-8);
    }
  }
}

TEST(Path, ProjectionFindsTheNearestOfAllSamples) {
  const Path path = Path::create(wavy_loop(7), true).value();
  Random random{11};
  for (int k = 0; k < 100; ++k) {
    const Vec2 point{random.uniform(-250.0, 250.0), random.uniform(-250.0, 250.0)};
    double nearest = std::numeric_limits<double>::infinity();
    for (double s = 0.0; s < path.length(); s += 0.05)
      nearest = std::min(nearest, (path.at(s).position - point).norm());
    const Projection foot = path.project(point);
    EXPECT_LE(foot.distance, nearest + 1e-12);
    EXPECT_NEAR(foot.distance, nearest, 1e-3) << "samples are 0.05 m apart";
    EXPECT_NEAR(std::fabs(foot.d), foot.distance, 1e-6);
  }
}

TEST(Path, WarmStartedProjectionStaysOnItsLegOfTheRoad) {
  // Two legs 10 m apart: a point nearer to the other leg stays on the leg it was on.
  const std::vector<Vec2> points{{0, 0}, {50, 0}, {100, 0}, {105, 5}, {100, 10}, {50, 10}, {0, 10}, {-5, 5}};
  const Path path = Path::create(points, true).value();
  EXPECT_GT(path.project({50.0, 6.0}).s, 100.0);
  const Projection warm = path.project({50.0, 6.0}, 48.0, 20.0);
  EXPECT_NEAR(warm.s, 50.0, 3.0) << "the spline bows a little between the legs";
  EXPECT_NEAR(warm.d, 6.0, 0.5);
}

TEST(Path, OpenPathGoesStraightOnBeyondItsEnds) {
  const Path path = Path::create(std::vector<Vec2>{{0, 0}, {10, 0}, {20, 3}, {30, 10}}, false).value();
  const PathPoint end = path.at(path.length());
  const PathPoint beyond = path.at(path.length() + 5.0);
  EXPECT_NEAR(end.curvature, 0.0, 1e-12) << "natural end";
  EXPECT_NEAR((beyond.position - end.position).norm(), 5.0, 1e-12);
  EXPECT_DOUBLE_EQ(beyond.heading, end.heading);
  EXPECT_EQ(beyond.curvature, 0.0);
  EXPECT_NEAR((path.at(-4.0).position - path.at(0.0).position).norm(), 4.0, 1e-12);
  const Projection foot = path.project(beyond.position + Vec2{0.0, 1.0});
  EXPECT_DOUBLE_EQ(foot.s, path.length());
  EXPECT_LT(std::fabs(foot.d), foot.distance);
}

TEST(Path, TwoPointsAreAStraightLine) {
  const Path path = Path::create(std::vector<Vec2>{{1, 1}, {4, 5}}, false).value();
  EXPECT_DOUBLE_EQ(path.length(), 5.0);
  EXPECT_NEAR(path.at(2.5).position.x(), 2.5, 1e-15);
  EXPECT_NEAR(path.project({1.0, 5.0}).d, 2.4, 1e-12);
}

TEST(Path, WrapAndDifferenceTakeTheShortestWay) {
  const Path path = Path::create(circle_points(50.0, 60), true).value();
  const double length = path.length();
  EXPECT_NEAR(path.wrap(-1.0), length - 1.0, 1e-12);
  EXPECT_NEAR(path.wrap(3.0 * length + 2.0), 2.0, 1e-9);
  EXPECT_EQ(path.wrap(-1e-18), 0.0) << "never length itself";
  EXPECT_NEAR(path.difference(1.0, length - 1.0), 2.0, 1e-9);
  EXPECT_NEAR(path.difference(length - 1.0, 1.0), -2.0, 1e-9);
  const Path open = Path::create(std::vector<Vec2>{{0, 0}, {10, 0}}, false).value();
  EXPECT_EQ(open.wrap(12.0), 10.0);
  EXPECT_EQ(open.difference(1.0, 9.0), -8.0);
}

TEST(Path, RebuildWithinCapacityEqualsCreateAndRefusesTheRest) {
  const std::vector<Vec2> points = wavy_loop(9);
  const Path fresh = Path::create(points, true).value();
  Path path = Path::with_capacity(200);
  EXPECT_TRUE(path.is_empty());
  EXPECT_EQ(path.capacity(), 200);
  ASSERT_TRUE(path.rebuild(circle_points(20.0, 150), true));
  ASSERT_TRUE(path.rebuild(points, true));
  EXPECT_EQ(path.length(), fresh.length());
  EXPECT_EQ(path.at(77.0).curvature, fresh.at(77.0).curvature);

  std::vector<Vec2> broken = points;
  broken[4].x() = kNan;
  EXPECT_FALSE(path.rebuild(broken, true));
  EXPECT_FALSE(path.rebuild(circle_points(50.0, 201), true)) << "more than the capacity";
  EXPECT_FALSE(path.rebuild(std::vector<Vec2>{{0, 0}, {0, 0}, {1, 1}}, true));
  EXPECT_EQ(path.length(), fresh.length()) << "refused data change nothing";
}

TEST(Path, RunsWithoutAllocating) {
  const std::vector<Vec2> points = wavy_loop(2);
  Path path = Path::with_capacity(400);
  const test::AllocationGuard guard;
  ASSERT_TRUE(path.rebuild(points, true));
  ASSERT_TRUE(path.rebuild(points, false));
  double sum = 0.0;
  for (double s = 0.0; s < path.length(); s += 1.0)
    sum += path.at(s).curvature + path.project(points[7], s, 30.0).d;
  sum += path.project(points[7]).d;
  EXPECT_EQ(guard.count(), 0);
  EXPECT_TRUE(std::isfinite(sum));
}

TEST(Path, RefusesWhatIsNoCurveAndNamesThePoint) {
  const auto message = [](std::vector<Vec2> points, bool closed) {
    return test::refusal_of(Path::create(points, closed));
  };
  EXPECT_EQ(message({{0, 0}}, false), "points: got 1, expected at least 2");
  EXPECT_EQ(message({{0, 0}, {1, 0}}, true), "points: got 2, expected at least 3 for a closed path");
  EXPECT_EQ(message({{0, 0}, {1, kNan}}, false),
            "points[1]: got (1, nan), expected finite coordinates within 1e7 m");
  EXPECT_EQ(message({{0, 0}, {1e9, 0}}, false),
            "points[1]: got (1e+09, 0), expected finite coordinates within 1e7 m");
  EXPECT_EQ(message({{0, 0}, {1, 0}, {1, 0}, {2, 2}}, false),
            "points[2]: got (1, 0), expected a point apart from the one before");
  EXPECT_EQ(message({{0, 0}, {1, 0}, {1, 1}, {0, 0}}, true),
            "points[3]: got (0, 0), expected a last point apart from the first");
}

TEST(Path, AnswersNonFiniteQuestionsWithoutHarm) {
  const Path path = Path::create(circle_points(50.0, 60), true).value();
  EXPECT_TRUE(std::isnan(path.at(kNan).curvature));
  EXPECT_TRUE(std::isnan(path.project({kNan, 0.0}).d));
  EXPECT_TRUE(std::isnan(path.project({kNan, 0.0}, 10.0, 5.0).d));
  EXPECT_NEAR(path.project({49.0, 0.0}, kNan, 5.0).d, 1.0, 1e-3) << "no guess: the whole curve";
  EXPECT_TRUE(std::isfinite(path.at(1e12).heading));
  EXPECT_EQ(Path{}.at(3.0).curvature, 0.0);
  EXPECT_EQ(Path{}.project({1.0, 2.0}).s, 0.0);
}

TEST(Path, SurvivesWildPointsWithFiniteNumbers) {
  Random random{4};
  Path path = Path::with_capacity(64);
  for (int round = 0; round < 500; ++round) {
    std::vector<Vec2> points;
    const int count = 3 + static_cast<int>(random.bits() % 60U);
    for (int i = 0; i < count; ++i) {
      const double scale = std::pow(10.0, random.uniform(-5.0, 6.9));
      points.emplace_back(random.uniform(-scale, scale), random.uniform(-scale, scale));
    }
    if (!path.rebuild(points, round % 2 == 0)) continue;
    ASSERT_TRUE(std::isfinite(path.length()));
    for (int k = 0; k < 20; ++k) {
      const PathPoint p = path.at(random.uniform(-0.2, 1.2) * path.length());
      ASSERT_TRUE(p.position.is_finite() && std::isfinite(p.heading) && std::isfinite(p.curvature));
      const Projection foot = path.project({random.uniform(-1e3, 1e3), random.uniform(-1e3, 1e3)},
                                           random.uniform(0.0, path.length()), 50.0);
      ASSERT_TRUE(std::isfinite(foot.d) && foot.s >= 0.0 && foot.s <= path.length());
    }
  }
}

// Where a curve passes a point twice, the direction decides, if neither pass is much nearer.
TEST(Path, ProjectsAlongTheDirectionWhereItCrossesItself) {
  const Path eight = Path::create(test::eight_points(200, 60.0), true).value();
  const double half = 0.5 * eight.length();
  for (const double first : {0.0, half}) {
    for (double s = -12.0; s <= 12.0; s += 0.5) {
      for (const double d : {-3.0, 0.0, 2.0}) {
        const double heading = eight.at(first + s).heading;
        const Projection there = eight.project_along(offset_point(eight, first + s, d), heading + 0.3, 5.0);
        EXPECT_NEAR(eight.difference(there.s, first + s), 0.0, 1e-6) << first << ' ' << s << ' ' << d;
        EXPECT_NEAR(there.d, d, 1e-6);
      }
    }
  }
  // Elsewhere, and without reach, it is the nearest point, bit for bit, whatever the direction.
  for (double s = 0.0; s < eight.length(); s += 7.3) {
    const Vec2 point = eight.at(s).position + Vec2{1.3, -0.4};
    const Projection nearest = eight.project(point);
    EXPECT_EQ(eight.project_along(point, 2.0, 0.0).s, nearest.s);
    if (std::fabs(point.x()) > 20.0) {
      EXPECT_EQ(eight.project_along(point, 2.0, 5.0).s, nearest.s) << s;
    }
  }
}

}  // namespace
}  // namespace chicane::road
