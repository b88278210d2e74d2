// SPDX-License-Identifier: MIT
#include "chicane/road/track.hpp"

#include "chicane/base/math.hpp"
#include "chicane/base/random.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"

namespace chicane::road {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Closed loop with left and right turns down to R ≈ 20 m; true position at an angle.
Vec2 loop(double angle) {
  const double radius = 150.0 + 20.0 * std::sin(4.0 * angle);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

std::vector<TrackPoint> loop_points(int count, double sigma, std::uint64_t seed = 1) {
  Random random{seed};
  std::vector<TrackPoint> points;
  for (int i = 0; i < count; ++i) {
    const double angle = kTwoPi * (i + random.uniform(-0.3, 0.3)) / count;
    points.push_back({loop(angle) + sigma * Vec2{random.normal(), random.normal()}, 5.0, 4.0});
  }
  return points;
}

std::string refusal(const std::vector<TrackPoint>& points, bool closed, const TrackOptions& options = {}) {
  return test::refusal_of(Track::create("test", points, closed, options));
}

TEST(Track, FollowsCleanPointsToTheMillimetre) {
  const Track track = Track::create("loop", loop_points(300, 0.0), true).value();
  for (double angle = 0.0; angle < kTwoPi; angle += 0.01)
    EXPECT_LT(track.centre().project(loop(angle)).distance, 0.005);
  EXPECT_NEAR(track.left_width(123.0), 5.0, 0.005);
}

TEST(Track, RemovesNoiseWithoutShiftingTheRoad) {
  const double sigma = 0.1;
  const Track clean = Track::create("clean", loop_points(4000, 0.0), true).value();
  double mean_offset = 0.0;
  double curvature_error = 0.0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Track noisy = Track::create("noisy", loop_points(250, sigma, seed), true).value();
    for (double s = 0.0; s < clean.length(); s += 1.0, ++count) {
      const PathPoint truth = clean.centre().at(s);
      const Projection foot = noisy.centre().project(truth.position);
      mean_offset += foot.d;
      EXPECT_LT(foot.distance, 3.5 * sigma);
      const double error = noisy.centre().at(foot.s).curvature - truth.curvature;
      curvature_error += error * error;
    }
  }
  EXPECT_NEAR(mean_offset / count, 0.0, 0.01) << "no drift inwards";
  // The smoothing length is chosen for 0.003 1/m; second differences of the raw points have about 0.02 1/m.
  EXPECT_LT(std::sqrt(curvature_error / count), 0.006);
}

TEST(Track, EdgesStayWhereThePointsPutThem) {
  // The reference points zigzag by ± 0.1 m between straight edges: the line goes straight, the edges do not
  // move.
  std::vector<TrackPoint> points;
  for (int i = 0; i <= 60; ++i) {
    const double zigzag = i % 2 == 0 ? 0.1 : -0.1;
    points.push_back({{5.0 * i, zigzag}, 5.0 - zigzag, 4.0 + zigzag});
  }
  const Track track = Track::create("zigzag", points, false, {.smoothing_sigma = 0.2}).value();
  for (double s = 20.0; s < 280.0; s += 1.0) {
    const PathPoint p = track.centre().at(s);
    EXPECT_NEAR(p.position.y(), 0.0, 0.03) << "the zigzag is gone";
    EXPECT_NEAR(p.position.y() + track.left_width(s), 5.0, 0.005);
    EXPECT_NEAR(p.position.y() - track.right_width(s), -4.0, 0.005);
  }
}

TEST(Track, KeepsEachSidesWidth) {
  std::vector<TrackPoint> points = loop_points(200, 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].left = 3.0 + 0.01 * static_cast<double>(i);
  const Track track = Track::create("widening", points, true).value();
  for (std::size_t i = 0; i < points.size(); i += 7) {
    const double s = track.centre().project(points[i].position).s;
    EXPECT_NEAR(track.left_width(s), points[i].left, 0.02);
    EXPECT_NEAR(track.right_width(s + track.length()), points[i].right, 0.02);
  }
}

TEST(Track, EdgeDistanceIsPositiveOnTheRoad) {
  const Track track = Track::create("loop", loop_points(300, 0.0), true).value();
  EXPECT_NEAR(track.edge_distance({10.0, 1.0, 1.0}), 4.0, 0.01);
  EXPECT_NEAR(track.edge_distance({10.0, -1.0, 1.0}), 3.0, 0.01);
  EXPECT_NEAR(track.edge_distance({10.0, 6.0, 6.0}), -1.0, 0.01);
  EXPECT_NEAR(track.edge_distance({10.0, -4.5, 4.5}), -0.5, 0.01);
}

TEST(Track, StartsAtTheFirstPointAndKeepsTheRawPoints) {
  const std::vector<TrackPoint> points = loop_points(300, 0.05);
  const Track track = Track::create("loop", points, true, {.start_s = -10.0, .start_d = 0.5}).value();
  EXPECT_LT((track.centre().at(0.0).position - points[0].position).norm(), 0.4);
  EXPECT_NEAR(track.start_s(), track.length() - 10.0, 1e-9);
  EXPECT_EQ(track.start_d(), 0.5);
  ASSERT_EQ(track.raw_points().size(), points.size());
  EXPECT_EQ(track.raw_points()[17].position, points[17].position);
}

TEST(Track, SmoothsAlikeAcrossTheSeam) {
  // Starting the same loop at another point must not change the line: nothing special happens at s = 0.
  std::vector<TrackPoint> points = loop_points(250, 0.1);
  const Track a = Track::create("a", points, true).value();
  std::rotate(points.begin(), points.begin() + 100, points.end());
  const Track b = Track::create("b", points, true).value();
  EXPECT_NEAR(a.length(), b.length(), 1e-3);
  for (double s = 0.0; s < a.length(); s += 2.0)
    EXPECT_LT(b.centre().project(a.centre().at(s).position).distance, 2e-3);
}

TEST(Track, RotatingChangesNothingAndMirroringSwapsTheSides) {
  const std::vector<TrackPoint> points = loop_points(250, 0.1);
  std::vector<TrackPoint> turned;
  std::vector<TrackPoint> mirrored;
  for (const TrackPoint& p : points) {
    const Vec2 q = p.position;
    turned.push_back({{0.6 * q.x() - 0.8 * q.y() + 40.0, 0.8 * q.x() + 0.6 * q.y() - 9.0}, p.left, p.right});
    mirrored.push_back({{q.x(), -q.y()}, p.right, p.left});
  }
  const Track a = Track::create("a", points, true).value();
  const Track b = Track::create("b", turned, true).value();
  const Track c = Track::create("c", mirrored, true).value();
  EXPECT_NEAR(a.length(), b.length(), 1e-8);
  EXPECT_NEAR(a.length(), c.length(), 1e-9);
  EXPECT_EQ(a.centre().turning(), -c.centre().turning());
  for (double s = 0.5; s < a.length(); s += 3.0) {
    EXPECT_NEAR(a.centre().at(s).curvature, b.centre().at(s).curvature, 1e-9);
    EXPECT_NEAR(a.centre().at(s).curvature_slope, b.centre().at(s).curvature_slope, 1e-8);
    EXPECT_NEAR(a.left_width(s), b.left_width(s), 1e-8);
    EXPECT_NEAR(a.centre().at(s).curvature, -c.centre().at(s).curvature, 1e-9);
    EXPECT_NEAR(a.left_width(s), c.right_width(s), 1e-8);
    const PathPoint p = a.centre().at(s);
    const Vec2 beside = p.position + 2.0 * Vec2{-std::sin(p.heading), std::cos(p.heading)};
    EXPECT_NEAR(c.centre().project({beside.x(), -beside.y()}).d, -2.0, 1e-9);
  }
}

TEST(Track, AcceptsFewAndFarPoints) {
  // A square of 400 m with only its corners: a smooth loop through them.
  const std::vector<TrackPoint> points{
      {{0, 0}, 5, 5}, {{400, 0}, 5, 5}, {{400, 400}, 5, 5}, {{0, 400}, 5, 5}};
  const Track track = Track::create("square", points, true).value();
  EXPECT_GT(track.length(), 1600.0);
  EXPECT_LT(track.length(), 2000.0);
  for (const TrackPoint& p : points)
    EXPECT_LT(track.centre().project(p.position).distance, 0.41) << "4 sigma";
}

TEST(Track, ShrinksItsSpacingForAModelTrack) {
  // 1 : 10 track with radii of a metre: 2 m knots would cut the corners.
  std::vector<TrackPoint> points;
  for (int i = 0; i < 120; ++i) {
    const double angle = kTwoPi * i / 120.0;
    points.push_back({{6.0 * std::cos(angle) + std::cos(5.0 * angle), 4.0 * std::sin(angle)}, 1.1, 1.1});
  }
  const Track track = Track::create("model", points, true, {.smoothing_sigma = 0.01}).value();
  for (const TrackPoint& p : points) EXPECT_LT(track.centre().project(p.position).distance, 0.051);
}

TEST(Track, ToleratesRepeatedPointsAmongOthers) {
  std::vector<TrackPoint> points = loop_points(300, 0.0);
  points.insert(points.begin() + 50, points[50]);
  points.push_back(points.front());
  EXPECT_NEAR(Track::create("loop", points, true).value().length(),
              Track::create("loop", loop_points(300, 0.0), true).value().length(), 0.01);
}

TEST(Track, OpenRoadsEndWhereTheirPointsEnd) {
  std::vector<TrackPoint> points;
  for (int i = 0; i <= 40; ++i) points.push_back({{10.0 * i, 0.001 * i * i * i}, 3.0, 4.0});
  const Track track = Track::create("open", points, false).value();
  EXPECT_FALSE(track.centre().is_closed());
  EXPECT_LT((track.centre().at(0.0).position - points.front().position).norm(), 0.2);
  EXPECT_LT((track.centre().at(track.length()).position - points.back().position).norm(), 0.2);
  EXPECT_NEAR(track.left_width(1e6), 3.0, 0.2);
}

TEST(Track, RefusesBadPointsAndNamesThem) {
  std::vector<TrackPoint> points = loop_points(100, 0.0);
  points[7].position.y() = kNan;
  EXPECT_NE(refusal(points, true).find("points[7]: got ("), std::string::npos);
  points = loop_points(100, 0.0);
  points[8].left = -2.0;
  EXPECT_EQ(refusal(points, true), "points[8].left: got -2, expected a width > 0 and <= 1000 m");
  points[8].left = 5.0;
  points[9].right = kNan;
  EXPECT_EQ(refusal(points, true), "points[9].right: got nan, expected a width > 0 and <= 1000 m");
  EXPECT_EQ(refusal({}, true), "points: got 0 with 0 different, expected at least 4 different ones");
  EXPECT_EQ(refusal(std::vector<TrackPoint>(50, {{1, 1}, 5, 5}), true),
            "points: got 50 with 1 different, expected at least 4 different ones");
  points = loop_points(100, 0.0);
  points[5].position.x() = 2e4;
  EXPECT_TRUE(refusal(points, true).starts_with("points[5]: got (20000, ")) << refusal(points, true);
  EXPECT_TRUE(refusal(points, true).ends_with("expected a point within 10 km of the one before"));
  const std::vector<TrackPoint> tiny{{{0, 0}, 5, 5}, {{0.1, 0}, 5, 5}, {{0.1, 0.1}, 5, 5}, {{0, 0.1}, 5, 5}};
  EXPECT_EQ(refusal(tiny, true), "points: got a line of 0.4 m, expected 1 to 4e+05 m");
}

TEST(Track, RefusesOptionsOutOfRange) {
  const std::vector<TrackPoint> points = loop_points(100, 0.0);
  EXPECT_EQ(refusal(points, true, {.spacing = 0.0}), "spacing: got 0, expected a number in [0.05, 10]");
  EXPECT_EQ(refusal(points, true, {.smoothing_sigma = kNan}),
            "smoothing_sigma: got nan, expected a number in [0, 1]");
  EXPECT_EQ(refusal(points, true, {.kerb_width = 4.0}), "kerb_width: got 4, expected a number in [0, 3]");
  EXPECT_EQ(refusal(points, true, {.start_d = 6.0}), "start_d: got 6, expected a place on the road");
}

TEST(Track, RefusesALineThatLeavesAPointByTheRoadsWidth) {
  std::vector<TrackPoint> points = loop_points(100, 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].position *= i % 2 == 0 ? 0.985 : 1.015;
    points[i].left = points[i].right = 0.3;
  }
  const std::string words = refusal(points, true, {.smoothing_sigma = 1.0});
  EXPECT_TRUE(words.starts_with("points[18]: got 0.414 m beside")) << words;
  EXPECT_TRUE(
      words.ends_with(" m beside the smooth line, expected less than the 0.3 m to the edge of the road"))
      << words;
}

/// 4 m to each edge.
std::vector<TrackPoint> eight(double height, double shift = 0.25) {
  return test::with_widths(test::eight_points(200, height, shift), 4.0, 4.0);
}
TEST(Track, TakesARoadThatCrossesItself) {
  const Track track = Track::create("eight", eight(60.0), true).value();
  EXPECT_EQ(track.crossings(), 1);
  EXPECT_NEAR(track.centre().turning(), 0.0, 1e-9);
  EXPECT_EQ(Track::create("loop", loop_points(200, 0.0), true)->crossings(), 0);
  // The seam may lie at the crossing itself, with a point of each passage in the same place.
  EXPECT_EQ(Track::create("eight", eight(60.0, 0.0), true).value().crossings(), 1);
}

TEST(Track, RefusesRoadsThatMergeAndNamesThePoint) {
  const std::string message = refusal(eight(12.0), true);  // cross at 27 degrees
  EXPECT_TRUE(message.starts_with("points[199]: got a line that crosses itself near (")) << message;
  EXPECT_NE(message.find("after points[99], expected no crossing, or one of at least 30 degrees"),
            std::string::npos)
      << message;
  EXPECT_EQ(refusal(eight(15.0), true), "");  // at 33 degrees
}

TEST(Track, RefusesALineThatCrossesItself) {
  std::vector<TrackPoint> loop, out_and_back;
  for (int i = 0; i < 40; ++i) loop.push_back({{-200.0 + 5.0 * i, 0.0}, 4.0, 4.0});
  for (int i = 0; i < 12; ++i) {  // a circle of 4.5 m, as measurements that jump back make it
    const double angle = kTwoPi * i / 12.0;
    loop.push_back({{4.5 * std::sin(angle), 4.5 - 4.5 * std::cos(angle)}, 4.0, 4.0});
  }
  for (int i = 1; i < 40; ++i) loop.push_back({{5.0 * i, 0.5 * i}, 4.0, 4.0});
  std::vector<TrackPoint> in_the_wrong_order = loop_points(200, 0.0);
  std::reverse(in_the_wrong_order.begin() + 60, in_the_wrong_order.begin() + 120);
  for (int i = 0; i < 50; ++i) out_and_back.push_back({{5.0 * i, 0.0}, 4.0, 4.0});
  for (std::size_t i = 50; i-- > 0;) out_and_back.push_back(out_and_back[i]);
  EXPECT_THAT(refusal(loop, false, {.spacing = 0.5}), HasSubstr("crosses itself"));
  EXPECT_THAT(refusal(in_the_wrong_order, true), HasSubstr("crosses itself"));
  EXPECT_THAT(refusal(out_and_back, true), HasSubstr("crosses itself"));
}

TEST(Track, OpenRoadsMayHaveAFinish) {
  const std::vector<TrackPoint> points = test::straight_points(30, 4.0, 4.0);
  EXPECT_NEAR(Track::create("a", points, false, {.start_s = 10.0})->lap_length(), 290.0, 1e-6);
  EXPECT_NEAR(Track::create("a", points, false, {.start_s = 10.0, .finish_s = 210.0})->lap_length(), 200.0,
              1e-6);
  EXPECT_EQ(refusal(points, false, {.start_s = 50.0, .finish_s = 40.0}),
            "finish_s: got 40, expected a place behind the start at 50 and on the road of 300 m");
  EXPECT_EQ(refusal(points, false, {.finish_s = 400.0}),
            "finish_s: got 400, expected a place behind the start at 0 and on the road of 300 m");
  EXPECT_EQ(refusal(loop_points(100, 0.0), true, {.finish_s = 40.0}),
            "finish_s: got 40, expected none on a closed road");
  const Track loop = Track::create("loop", loop_points(100, 0.0), true).value();
  EXPECT_EQ(loop.lap_length(), loop.length());
  EXPECT_NEAR(loop.scaled(0.1).lap_length(), 0.1 * loop.length(), 1e-9);
}

TEST(Track, ScaledIsTheSameRoadSmaller) {
  const Track large =
      *Track::create("loop", loop_points(100, 0.0), true, {.kerb_width = 0.5, .start_s = 20.0});
  const Track small = large.scaled(0.1);
  EXPECT_NEAR(small.length(), 0.1 * large.length(), 1e-12);
  EXPECT_DOUBLE_EQ(small.kerb_width(), 0.05);
  EXPECT_DOUBLE_EQ(small.start_s(), 2.0);
  for (double s = 0.0; s < large.length(); s += 7.3) {
    const PathPoint a = large.centre().at(s), b = small.centre().at(0.1 * s);
    EXPECT_NEAR(b.position.x(), 0.1 * a.position.x(), 1e-9);
    EXPECT_NEAR(b.position.y(), 0.1 * a.position.y(), 1e-9);
    EXPECT_NEAR(b.heading, a.heading, 1e-9);
    EXPECT_NEAR(b.curvature, 10.0 * a.curvature, 1e-7);
    EXPECT_NEAR(small.left_width(0.1 * s), 0.1 * large.left_width(s), 1e-9);
    const Vec2 beside = a.position + Vec2{0.4, -0.7};
    const Projection on_large = large.centre().project(beside, s, 6.0);
    const Projection on_small = small.centre().project(0.1 * beside, 0.1 * s, 0.6);
    EXPECT_NEAR(on_small.s, 0.1 * on_large.s, 1e-9);
    EXPECT_NEAR(on_small.d, 0.1 * on_large.d, 1e-9);
  }
}

TEST(Track, JudgesAHundredThousandPoints) {
  // Also a time limit in effect: a comparison of all pairs would take minutes and trip the test's time-out.
  std::vector<TrackPoint> points = loop_points(100000, 0.0);
  EXPECT_EQ(refusal(points, true), "");
  Random random{3};
  for (TrackPoint& p : points) p.position = {random.uniform(0.0, 10.0), random.uniform(0.0, 10.0)};
  EXPECT_NE(refusal(points, true), "");
}

/// A circle of 50 m whose points are `off` [m] inside and outside in turns.
Track rough_circle(double off, double sigma) {
  bool is_inside = false;
  const auto points = test::points_round(120, [&](double) {
    is_inside = !is_inside;
    return is_inside ? 50.0 + off : 50.0 - off;
  });
  return *Track::create("circle", test::with_widths(points, 4.0, 4.0), true, {.smoothing_sigma = sigma});
}

TEST(PointFit, IsTheNoiseThatSmoothingTookAway) {
  const PointFit fit = point_fit(rough_circle(0.2, 0.2));
  EXPECT_NEAR(fit.rms, 0.2, 0.03);  // the smooth line follows the noise a little
  EXPECT_GE(fit.most, fit.rms);
}

TEST(PointFit, IsNothingForALineThroughItsPoints) {
  EXPECT_LT(point_fit(rough_circle(0.0, 0.0)).most, 0.01);  // resampled every 2 m: chords of the spline
}

}  // namespace
}  // namespace chicane::road
