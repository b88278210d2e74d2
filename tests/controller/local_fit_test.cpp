// SPDX-License-Identifier: MIT
#include "chicane/controller/cubic_problem.hpp"

#include <Eigen/QR>

#include "chicane/base/random.hpp"
#include "support/chicane_test.hpp"

namespace chicane::controller {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

model::Measurement with_waypoints(const std::vector<Vec2>& points) {
  model::Measurement now;
  now.waypoint_count = static_cast<int>(points.size());
  std::copy(points.begin(), points.end(), now.waypoints.begin());
  return now;
}

TEST(CarFrame, PutsWhatIsAheadOnXAndWhatIsLeftOnY) {
  const auto now = with_waypoints({{10.0, 25.0}, {0.0, 20.0}});
  const model::Pose car{10.0, 20.0, 0.5 * kPi};  // looking along W's y
  const LocalPoints local = to_car_frame(now, car);
  ASSERT_EQ(local.count, 2);
  EXPECT_NEAR(local.points[0].x(), 5.0, 1e-12);
  EXPECT_NEAR(local.points[0].y(), 0.0, 1e-12);
  EXPECT_NEAR(local.points[1].x(), 0.0, 1e-12);
  EXPECT_NEAR(local.points[1].y(), 10.0, 1e-12);
}

TEST(CarFrame, IsTheSameByRotationAndByRadiusAndAngle) {
  Random random{3};
  for (int turn = 0; turn < 200; ++turn) {
    std::vector<Vec2> points;
    for (int i = 0; i < 6; ++i)
      points.emplace_back(random.uniform(-200.0, 200.0), random.uniform(-200.0, 200.0));
    const model::Pose car{random.uniform(-200.0, 200.0), random.uniform(-200.0, 200.0),
                          random.uniform(-7.0, 7.0)};
    const LocalPoints a = to_car_frame(with_waypoints(points), car);
    const LocalPoints b = to_car_frame_polar(with_waypoints(points), car);
    ASSERT_EQ(a.count, b.count);
    // 1e-12: rounding of an arc tangent and a sine, times 600 m.
    for (std::size_t i = 0; i < 6; ++i) ASSERT_LT((a.points[i] - b.points[i]).norm(), 1e-12 * 600.0);
  }
}

TEST(CarFrame, SkipsPointsThatAreNotFiniteAndRejectsAnImpossibleCount) {
  auto now =
      with_waypoints({{1.0, 2.0}, {kNaN, 1.0}, {3.0, std::numeric_limits<double>::infinity()}, {4.0, 5.0}});
  EXPECT_EQ(to_car_frame(now, {}).count, 2);
  now.waypoint_count = 1'000'000;
  EXPECT_LE(to_car_frame(now, {}).count, model::Measurement::kMaxWaypoints);
  now.waypoint_count = -5;
  EXPECT_EQ(to_car_frame_polar(now, {}).count, 0);
}

TEST(FitCubic, FindsTheCubicThatThePointsLieOn) {
  const Cubic truth{{1.5, -0.2, 0.01, -2e-4}};
  std::vector<Vec2> points;
  for (const double x : {-12.0, 3.0, 18.0, 33.0, 60.0, 95.0}) points.emplace_back(x, truth.at(x));
  Cubic fit;
  ASSERT_TRUE(fit_cubic(points, fit));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(fit.c[i], truth.c[i], 1e-10) << i;
}

TEST(FitCubic, EqualsEigensHouseholderSolutionOnRandomPoints) {
  Random random{17};
  for (int turn = 0; turn < 500; ++turn) {
    const int count = 4 + static_cast<int>(random.bits() % 20U);
    std::vector<Vec2> points;
    Eigen::MatrixXd a(count, 4);
    Eigen::VectorXd b(count);
    for (int i = 0; i < count; ++i) {
      const double x = 5.0 * i + random.uniform(-2.0, 2.0) - 10.0;
      points.emplace_back(x, random.uniform(-20.0, 20.0));
      a.row(i) << 1.0, x, x * x, x * x * x;
      b(i) = points.back().y();
    }
    const Eigen::VectorXd expected = a.householderQr().solve(b);
    Cubic fit;
    ASSERT_TRUE(fit_cubic(points, fit));
    // 1e-7 relative: condition of the unscaled powers (about 1e6) times rounding, with room.
    for (int i = 0; i < 4; ++i)
      ASSERT_NEAR(fit.c[static_cast<std::size_t>(i)], expected(i), 1e-7 * (1.0 + std::fabs(expected(i))));
  }
}

TEST(FitCubic, LowersTheDegreeForFewerPoints) {
  Cubic fit;
  ASSERT_TRUE(fit_cubic(std::vector<Vec2>{{0.0, 1.0}, {10.0, 3.0}}, fit));
  EXPECT_NEAR(fit.at(5.0), 2.0, 1e-12);
  EXPECT_EQ(fit.c[2], 0.0);
  EXPECT_EQ(fit.c[3], 0.0);
  ASSERT_TRUE(fit_cubic(std::vector<Vec2>{{0.0, 1.0}, {10.0, 2.0}, {20.0, 5.0}}, fit));
  EXPECT_NEAR(fit.at(20.0), 5.0, 1e-12);
  EXPECT_EQ(fit.c[3], 0.0);
}

TEST(FitCubic, HasTheOrderThatIsAsked) {
  std::vector<Vec2> points;
  for (const double x : {-3.0, -1.0, 1.0, 3.0}) points.emplace_back(x, 1.0 + x * x);
  Cubic fit;
  ASSERT_TRUE(fit_cubic(points, fit, 2));
  EXPECT_NEAR(fit.at(3.0), 10.0, 1e-12);
  ASSERT_TRUE(fit_cubic(points, fit, 1));
  EXPECT_NEAR(fit.c[0], 6.0, 1e-12) << "the mean";
  EXPECT_NEAR(fit.c[1], 0.0, 1e-12);
  EXPECT_EQ(fit.c[2], 0.0);
  EXPECT_EQ(fit.c[3], 0.0);
}

TEST(FitCubic, TakesTheMeanWherePointsShareAnX) {
  Cubic fit;
  ASSERT_TRUE(fit_cubic(std::vector<Vec2>{{0.0, 1.0}, {0.0, 3.0}, {10.0, 5.0}, {10.0, 7.0}}, fit));
  EXPECT_NEAR(fit.at(0.0), 2.0, 1e-9);
  EXPECT_NEAR(fit.at(10.0), 6.0, 1e-9);
}

TEST(FitCubic, RefusesALineThatHasNoExtentAhead) {
  Cubic fit{{9.0, 9.0, 9.0, 9.0}};
  EXPECT_FALSE(fit_cubic(std::vector<Vec2>{}, fit));
  EXPECT_FALSE(fit_cubic(std::vector<Vec2>{{5.0, 5.0}}, fit));
  EXPECT_FALSE(fit_cubic(std::vector<Vec2>{{5.0, 0.0}, {5.0, 10.0}, {5.0, 20.0}}, fit));
  EXPECT_EQ(fit.c[0], 9.0);
}

TEST(FitCubic, WorksWithAllPointsBehind) {
  Cubic fit;
  ASSERT_TRUE(fit_cubic(std::vector<Vec2>{{-50.0, 5.0}, {-35.0, 3.5}, {-20.0, 2.0}, {-5.0, 0.5}}, fit));
  EXPECT_NEAR(fit.at(0.0), 0.0, 1e-9);
  EXPECT_NEAR(fit.slope(0.0), -0.1, 1e-9);
}

}  // namespace
}  // namespace chicane::controller
