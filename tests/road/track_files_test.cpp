// SPDX-License-Identifier: MIT

#include "chicane/protocol/track_codec.hpp"
#include "chicane/road/track.hpp"
#include "support/chicane_test.hpp"
#include "support/folder.hpp"

// The shipped tracks, and the public ones of tools/fetch_circuits.sh where they are.
namespace chicane::road {
namespace {

const std::string kSource = CHICANE_SOURCE_DIR;

/// What is measured of the road that the reader makes.
struct Measured {
  std::vector<double> widths;                    ///< right plus left [m], in order
  double left = 0.0, right = 0.0, window = 0.0;  ///< sharpest bends, and the sharpest 20 m [1/m]
  double rms = 0.0, largest = 0.0;               ///< distances of its points [m]
};

/// Edges have to stay where its points put them, within what is smoothed.
Measured measured(const Track& track) {
  Measured road;
  for (double s = 0.0; s < track.length(); s += 0.5) {
    const PathPoint at = track.centre().at(s);
    road.widths.push_back(track.left_width(s) + track.right_width(s));
    road.left = std::max(road.left, at.curvature);
    road.right = std::max(road.right, -at.curvature);
    road.window = std::max(road.window, std::fabs(track.centre().at(s + 20.0).heading - at.heading) / 20.0);
  }
  std::sort(road.widths.begin(), road.widths.end());
  double sum = 0.0;
  for (const TrackPoint& point : track.raw_points()) {
    const Projection foot = track.centre().project(point.position);
    sum += foot.distance * foot.distance;
    road.largest = std::max(road.largest, foot.distance);
    EXPECT_NEAR(track.left_width(foot.s), point.left + foot.d, 0.15) << "the left edge stays";
    EXPECT_NEAR(track.right_width(foot.s), point.right - foot.d, 0.15) << "the right edge stays";
  }
  road.rms = std::sqrt(sum / static_cast<double>(track.raw_points().size()));
  EXPECT_LT(road.largest, 0.42) << "4 sigma + 1 cm";
  EXPECT_LT(road.rms, 0.1) << "sigma";
  return road;
}

/// A row of a table in docs/reference/shipped.md.
template <class... Numbers>
void expect_row(const char* format, const std::string& name, Numbers... numbers) {
  char row[256];
  std::snprintf(row, sizeof row, format, name.c_str(), numbers...);
  std::fputs(row, stdout);
  EXPECT_THAT(test::content_of(kSource + "/docs/reference/shipped.md"), HasSubstr(row));
}

TEST(PublicTrack, TheTableInTheDocsIsTrue) {
  int found = 0;
  for (const std::string name : {"lake_track_waypoints", "IMS", "Monza", "Norisring", "Nuerburgring",
                                 "Silverstone", "Spa", "berlin_2018"}) {
    const std::string file = kSource + "/circuits/" + name + ".csv";
    if (!fs::exists(file)) continue;
    SCOPED_TRACE(name);
    ++found;
    const auto track = test::good(protocol::read_track(file));
    EXPECT_TRUE(track->centre().is_closed());
    const Measured road = measured(*track);
    expect_row("| `%s` | %.1f | %.2f / %.2f | %.1f | %.3f / %.3f |\n", name + ".csv", track->length(),
               road.widths.front(), road.widths.back(), 1.0 / std::max(road.left, road.right), road.rms,
               road.largest);
  }
  if (found == 0) GTEST_SKIP() << "tools/fetch_circuits.sh fetches them";
}

TEST(ShippedTrack, LakesideHasTheBendsOfTheOriginal) {
  const Track track = protocol::read_track(kSource + "/data/tracks/lakeside.csv").value();
  EXPECT_EQ(track.start_s(), 258.0);
  EXPECT_EQ(track.start_d(), -0.76);
  EXPECT_LT(std::fabs(track.centre().at(258.0).curvature), 0.006) << "a comfortable stretch";
  // The spline through the waypoints, as placed, peaks in the only right-hander.
  std::vector<Vec2> raw;
  for (const TrackPoint& point : track.raw_points()) raw.push_back(point.position);
  const Path spline = Path::create(raw, true).value();
  double sharpest_left = 0.0;
  double sharpest_right = 0.0;
  for (double s = 0.0; s < spline.length(); s += 0.5) {
    sharpest_left = std::max(sharpest_left, spline.at(s).curvature);
    sharpest_right = std::min(sharpest_right, spline.at(s).curvature);
  }
  EXPECT_NEAR(sharpest_right, -0.07, 0.005);
  EXPECT_LT(sharpest_left, 0.055);
}

std::string radius_of(double curvature) {
  if (curvature < 1e-3) return "–";
  char text[16];
  std::snprintf(text, sizeof text, "%.1f", 1.0 / curvature);
  return text;
}

TEST(ShippedTrack, TheTableInTheDocsIsTrue) {
  for (const std::string name :
       {"lakeside", "original-lake", "oval", "hairpins", "speedway", "crossover", "stage"}) {
    SCOPED_TRACE(name);
    const Track track = protocol::read_track(kSource + "/data/tracks/" + name + ".csv").value();
    const std::vector<TrackPoint>& points = track.raw_points();
    const std::size_t n = points.size(), last = track.centre().is_closed() ? n : n - 1;
    std::vector<double> gaps;
    for (std::size_t i = 0; i < last; ++i)
      gaps.push_back((points[(i + 1) % n].position - points[i].position).norm());
    double sight = 1e9;
    for (std::size_t i = 0; i + (last == n ? 0 : 3) < last; ++i)
      sight = std::min(sight, gaps[i] + gaps[(i + 1) % n] + gaps[(i + 2) % n] + gaps[(i + 3) % n]);
    std::sort(gaps.begin(), gaps.end());
    const Measured road = measured(track);
    expect_row("| `%s` | %.1f | %.2f / %.2f / %.2f | %s | %s | %s | %zu | %.1f / %.1f / %.1f | %.1f |\n",
               name, track.length(), road.widths.front(), road.widths[road.widths.size() / 2],
               road.widths.back(), radius_of(road.left).c_str(), radius_of(road.right).c_str(),
               radius_of(road.window).c_str(), n, gaps.front(), gaps[gaps.size() / 2], gaps.back(), sight);
  }
}

}  // namespace
}  // namespace chicane::road
