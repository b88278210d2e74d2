// SPDX-License-Identifier: MIT
#include "chicane/survey/sampled_line.hpp"
#include "support/chicane_test.hpp"

namespace chicane::survey {
namespace {

// Lengths of a degree of WGS 84 at 48 N after the series of the US National Geospatial-Intelligence Agency's
// table: 111.1999 km of latitude, 74.6256 km of longitude.
TEST(Geodesy, MeasuresTheEllipsoid) {
  const std::vector<Geographic> north{{47.99, 11.0}, {48.01, 11.0}};
  const std::vector<Vec2> a = to_plane(north);
  EXPECT_NEAR((a[1] - a[0]).norm(), 0.02 * 111'199.0, 1.0);
  const std::vector<Geographic> east{{48.0, 10.99}, {48.0, 11.01}};
  const std::vector<Vec2> b = to_plane(east);
  EXPECT_NEAR((b[1] - b[0]).norm(), 0.02 * 74'626.0, 1.0);
  EXPECT_GT(b[1].x(), b[0].x()) << "x is east";
  EXPECT_GT(a[1].y(), a[0].y()) << "y is north";
}

TEST(Geodesy, CrossesTheDateLine) {
  const std::vector<Geographic> places{{-17.0, 179.995}, {-17.0, -179.995}};
  const std::vector<Vec2> points = to_plane(places);
  EXPECT_NEAR(points[1].x() - points[0].x(), 1065.0, 2.0);
}

}  // namespace
}  // namespace chicane::survey
