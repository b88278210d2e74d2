// SPDX-License-Identifier: MIT

#include "chicane/protocol/track_codec.hpp"
#include "chicane/road/track.hpp"
#include "support/chicane_test.hpp"

// The shipped tracks, and the public ones of tools/fetch_circuits.sh where they are.
namespace chicane::road {
namespace {

const std::string kSource = CHICANE_SOURCE_DIR;

struct Known {
  const char* file;
  double length;       ///< of the closed polygon [m]
  double width_least;  ///< right plus left [m]
  double width_most;
  double radius_least;  ///< of the road the reader makes [m]: its own number, kept to notice a change
};

void expect_road(const std::string& file, const Known& known) {
  const Result<Track> track = protocol::read_track(file);
  ASSERT_TRUE(track) << track.error().message;
  EXPECT_EQ(track->centre().is_closed(), !file.ends_with("stage.csv"));
  EXPECT_NEAR(track->length(), known.length, 0.002 * known.length)
      << "a smooth line is a little longer or shorter than the polygon";
  double radius = 1e9;
  double least = 1e9;
  double most = 0.0;
  for (double s = 0.0; s < track->length(); s += 0.5) {
    radius = std::min(radius, 1.0 / std::fabs(track->centre().at(s).curvature));
    const double width = track->left_width(s) + track->right_width(s);
    least = std::min(least, width);
    most = std::max(most, width);
  }
  EXPECT_NEAR(least, known.width_least, 0.1);
  EXPECT_NEAR(most, known.width_most, 0.15);
  EXPECT_NEAR(radius, known.radius_least, 0.05 * known.radius_least);
  double sum = 0.0;
  for (const TrackPoint& point : track->raw_points()) {
    const Projection foot = track->centre().project(point.position);
    EXPECT_LT(foot.distance, 0.42) << "4 sigma + 1 cm";
    sum += foot.d * foot.d;
    EXPECT_NEAR(track->left_width(foot.s), point.left + foot.d, 0.15) << "the left edge stays";
    EXPECT_NEAR(track->right_width(foot.s), point.right - foot.d, 0.15) << "the right edge stays";
  }
  EXPECT_LT(std::sqrt(sum / static_cast<double>(track->raw_points().size())), 0.1) << "sigma";
}

std::string docs_page() {
  std::ostringstream page;
  page << std::ifstream{kSource + "/docs/reference/shipped.md"}.rdbuf();
  return page.str();
}

/// One row of the table of public tracks in docs/reference/shipped.md.
std::string public_row(const std::string& name) {
  const Track track = protocol::read_track(kSource + "/circuits/" + name).value();
  double least = 1e9;
  double most = 0.0;
  double curvature = 0.0;
  for (double s = 0.0; s < track.length(); s += 0.5) {
    const double width = track.left_width(s) + track.right_width(s);
    least = std::min(least, width);
    most = std::max(most, width);
    curvature = std::max(curvature, std::fabs(track.centre().at(s).curvature));
  }
  double sum = 0.0;
  double largest = 0.0;
  for (const TrackPoint& point : track.raw_points()) {
    const double distance = track.centre().project(point.position).distance;
    sum += distance * distance;
    largest = std::max(largest, distance);
  }
  char row[256];
  std::snprintf(row, sizeof row, "| `%s` | %.1f | %.2f / %.2f | %.1f | %.3f / %.3f |\n", name.c_str(),
                track.length(), least, most, 1.0 / curvature,
                std::sqrt(sum / static_cast<double>(track.raw_points().size())), largest);
  return row;
}

class PublicTrack : public ::testing::TestWithParam<Known> {};

TEST_P(PublicTrack, BecomesASaneRoad) {
  const std::string file = kSource + "/circuits/" + GetParam().file;
  if (!std::filesystem::exists(file))
    GTEST_SKIP() << file << " is not there: tools/fetch_circuits.sh fetches it";
  expect_road(file, GetParam());
  const std::string row = public_row(GetParam().file);
  std::fputs(row.c_str(), stdout);
  EXPECT_NE(docs_page().find(row), std::string::npos) << "docs/reference/shipped.md lacks this row: " << row;
}

INSTANTIATE_TEST_SUITE_P(Shared, PublicTrack,
                         ::testing::Values(Known{"lake_track_waypoints.csv", 1137.0, 9.0, 9.0, 20.7},
                                           Known{"IMS.csv", 4022.3, 15.3, 15.3, 185.0},
                                           Known{"Monza.csv", 5790.2, 7.52, 12.42, 9.8},
                                           Known{"Norisring.csv", 2295.8, 10.3, 20.97, 10.0},
                                           Known{"Nuerburgring.csv", 5144.1, 7.62, 21.35, 14.2},
                                           Known{"Silverstone.csv", 5886.8, 11.27, 17.84, 12.8},
                                           Known{"Spa.csv", 7000.1, 7.87, 16.42, 10.0},
                                           Known{"berlin_2018.csv", 2326.9, 6.89, 23.3, 8.0}),
                         [](const auto& each) {
                           return std::filesystem::path{each.param.file}.stem().string();
                         });

class ShippedTrack : public ::testing::TestWithParam<Known> {};

TEST_P(ShippedTrack, IsWhatItsPageSays) {
  expect_road(kSource + "/data/tracks/" + GetParam().file, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Tracks, ShippedTrack,
                         ::testing::Values(Known{"lakeside.csv", 1138.0, 8.05, 9.6, 18.7},
                                           Known{"original-lake.csv", 1137.5, 8.1, 9.7, 20.6},
                                           Known{"oval.csv", 642.7, 10.0, 10.0, 45.0},
                                           Known{"hairpins.csv", 926.9, 9.0, 9.0, 8.0},
                                           Known{"speedway.csv", 3348.4, 12.0, 12.0, 90.0},
                                           Known{"crossover.csv", 793.7, 10.0, 10.0, 29.2},
                                           Known{"stage.csv", 1432.1, 8.0, 8.0, 17.4}),
                         [](const auto& each) {
                           std::string name = std::filesystem::path{each.param.file}.stem().string();
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(ShippedTrack, LakesideHasTheSightOfTheOriginal) {
  const Track track = protocol::read_track(kSource + "/data/tracks/lakeside.csv").value();
  const std::vector<TrackPoint>& points = track.raw_points();
  ASSERT_EQ(points.size(), 80U);
  double shortest = 1e9;
  std::vector<double> gaps;
  for (std::size_t i = 0; i < 80; ++i) {
    double sight = 0.0;
    for (std::size_t k = 0; k < 4; ++k)
      sight += (points[(i + k + 1) % 80].position - points[(i + k) % 80].position).norm();
    shortest = std::min(shortest, sight);
    gaps.push_back((points[(i + 1) % 80].position - points[i].position).norm());
  }
  std::sort(gaps.begin(), gaps.end());
  EXPECT_NEAR(shortest, 26.7, 0.2);
  EXPECT_NEAR(gaps.front(), 4.9, 0.1);
  EXPECT_NEAR(gaps[40], 12.0, 0.5);
  EXPECT_NEAR(gaps.back(), 34.0, 0.6);
  EXPECT_EQ(track.start_s(), 258.0);
  EXPECT_EQ(track.start_d(), -0.76);
  EXPECT_LT(std::fabs(track.centre().at(258.0).curvature), 0.006) << "a comfortable stretch";

  // The spline through the waypoints, as placed, peaks in the only right-hander.
  std::vector<Vec2> raw;
  for (const TrackPoint& point : points) raw.push_back(point.position);
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

/// One row of the table in docs/reference/shipped.md.
std::string table_row(const std::string& name) {
  const Track track = protocol::read_track(kSource + "/data/tracks/" + name + ".csv").value();
  const std::vector<TrackPoint>& points = track.raw_points();
  const std::size_t n = points.size();
  std::vector<double> gaps;
  double sight = 1e9;
  const std::size_t last = track.centre().is_closed() ? n : n - 1;
  for (std::size_t i = 0; i < last; ++i) {
    double ahead = 0.0;
    for (std::size_t k = 0; k < 4; ++k)
      ahead += (points[(i + k + 1) % n].position - points[(i + k) % n].position).norm();
    if (last == n || i + 4 < n) sight = std::min(sight, ahead);
    gaps.push_back((points[(i + 1) % n].position - points[i].position).norm());
  }
  std::sort(gaps.begin(), gaps.end());
  std::vector<double> widths;
  double left = 0.0;
  double right = 0.0;
  double window = 0.0;
  for (double s = 0.0; s < track.length(); s += 0.5) {
    widths.push_back(track.left_width(s) + track.right_width(s));
    left = std::max(left, track.centre().at(s).curvature);
    right = std::max(right, -track.centre().at(s).curvature);
    window = std::max(window,
                      std::fabs(track.centre().at(s + 20.0).heading - track.centre().at(s).heading) / 20.0);
  }
  std::sort(widths.begin(), widths.end());
  const auto radius = [](double curvature) -> std::string {
    if (curvature < 1e-3) return "–";
    char text[16];
    std::snprintf(text, sizeof text, "%.1f", 1.0 / curvature);
    return text;
  };
  char row[256];
  std::snprintf(row, sizeof row,
                "| `%s` | %.1f | %.2f / %.2f / %.2f | %s | %s | %s | %zu | %.1f / %.1f / %.1f | %.1f |\n",
                name.c_str(), track.length(), widths.front(), widths[widths.size() / 2], widths.back(),
                radius(left).c_str(), radius(right).c_str(), radius(window).c_str(), n, gaps.front(),
                gaps[gaps.size() / 2], gaps.back(), sight);
  return row;
}

TEST(ShippedTrack, TheTableInTheDocsIsTrue) {
  for (const char* name :
       {"lakeside", "original-lake", "oval", "hairpins", "speedway", "crossover", "stage"}) {
    const std::string row = table_row(name);
    std::fputs(row.c_str(), stdout);
    EXPECT_NE(docs_page().find(row), std::string::npos)
        << "docs/reference/shipped.md lacks this row: " << row;
  }
}

}  // namespace
}  // namespace chicane::road
