// SPDX-License-Identifier: MIT
#include "chicane/survey/geodesy.hpp"

#include <algorithm>
#include <cmath>

#include "chicane/base/angle.hpp"
#include "chicane/base/math.hpp"

namespace chicane::survey {
namespace {

constexpr double kRadius = 6378137.0;  // of the equator, WGS 84 [m]
constexpr double kSquaredEccentricity = 6.69437999014e-3;

/// [deg] in (-180, 180], also across the date line.
double difference(double a, double b) noexcept { return std::remainder(a - b, 360.0); }

}  // namespace

Geographic middle_of(std::span<const Geographic> places) noexcept {
  if (places.empty()) return {};
  const Geographic& first = places.front();
  double south = 0.0, north = 0.0, west = 0.0, east = 0.0;
  for (const Geographic& each : places) {
    south = std::min(south, each.latitude - first.latitude);
    north = std::max(north, each.latitude - first.latitude);
    west = std::min(west, difference(each.longitude, first.longitude));
    east = std::max(east, difference(each.longitude, first.longitude));
  }
  return {first.latitude + 0.5 * (south + north), first.longitude + 0.5 * (west + east)};
}

std::vector<Vec2> to_plane(std::span<const Geographic> places) {
  const Geographic middle = middle_of(places);
  const double s = sin(middle.latitude * kPi / 180.0);
  const double w = 1.0 - kSquaredEccentricity * s * s;
  const double along_meridian = kRadius * (1.0 - kSquaredEccentricity) / (w * std::sqrt(w));
  const double normal = kRadius / std::sqrt(w);
  std::vector<Vec2> points;
  points.reserve(places.size());
  for (const Geographic& each : places) {
    const double north = (each.latitude - middle.latitude) * kPi / 180.0;
    const double east = difference(each.longitude, middle.longitude) * kPi / 180.0;
    // Meridians converge: a step east is shorter by the place's own latitude.
    points.push_back(
        {normal * cos(0.5 * (each.latitude + middle.latitude) * kPi / 180.0) * east, along_meridian * north});
  }
  return points;
}

}  // namespace chicane::survey
