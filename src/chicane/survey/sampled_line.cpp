// SPDX-License-Identifier: MIT
// Geometry of surveyed points: polylines, the plane of geographic coordinates, and the line between cones,
// which is the zero line of a field on a raster: distance to the right cones less distance to the left ones.
#include "chicane/survey/sampled_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/survey/image.hpp"

namespace chicane::survey {

double length_of(std::span<const Vec2> line, bool closed) noexcept {
  double length = closed && !line.empty() ? (line.front() - line.back()).norm() : 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

std::vector<Vec2> sampled(std::span<const Vec2> line, bool closed, double spacing) {
  constexpr double kMost = 1e6;
  const double length = length_of(line, closed);
  const auto count = static_cast<std::size_t>(std::clamp(std::round(length / spacing), 2.0, kMost));
  const double step = length / static_cast<double>(count);
  std::vector<Vec2> points;
  points.reserve(count + 1);
  double passed = 0.0;
  const std::size_t segments = closed ? line.size() : line.size() - 1;
  for (std::size_t i = 0; i < segments && points.size() < count; ++i) {
    const Vec2& a = line[i];
    const Vec2& b = line[(i + 1) % line.size()];
    const double segment = (b - a).norm();
    while (points.size() < count && step * static_cast<double>(points.size()) <= passed + segment) {
      const double share =
          segment > 0.0 ? (step * static_cast<double>(points.size()) - passed) / segment : 0.0;
      points.push_back(a + share * (b - a));
    }
    passed += segment;
  }
  if (!closed) points.push_back(line.back());
  return points;
}

double signed_area(std::span<const Vec2> line) noexcept {
  double doubled = 0.0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec2 a = line[i] - line[0];
    const Vec2 b = line[(i + 1) % line.size()] - line[0];
    doubled += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * doubled;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

namespace {

constexpr double kRadius = 6378137.0;                      // radius of the equator, WGS 84 [m]
constexpr double kSquaredEccentricity = 6.69437999014e-3;  // WGS 84

/// Difference of two longitudes in [-180, 180] deg, also across the date line.
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

namespace {

constexpr std::size_t kMostCones = 20000;  // bounds time; chosen
constexpr double kMostExtent = 20000.0;    // [m] extent of a course; chosen
constexpr double kMostCells = 2e6;         // cells of the raster; bounds memory; chosen
constexpr double kFinest = 0.05;           // [m] least side of a cell
constexpr double kGap = 1.6;               // length of a reported gap over the median of its neighbours
constexpr std::size_t kNear = 4;           // neighbours on each side that a gap is compared with
constexpr double kLeastShare = 0.2;        // narrowest width of a course over the median one
constexpr double kFarAway = 3.0;           // distance to the cones that ends a line, over its lower quartile
constexpr std::size_t kLeastPoints = 8;    // points of a zero line that is no noise; chosen

/// Raster of square cells round the cones.
struct Raster {
  Vec2 low{};
  double cell = 0.1;  ///< [m]
  int width = 0, height = 0;

  static Raster round(const Cones& cones) {
    Vec2 low = cones.left.front(), high = low;
    for (const std::vector<Vec2>* side : {&cones.left, &cones.right, &cones.either})
      for (const Vec2& cone : *side) {
        low = min(low, cone);
        high = max(high, cone);
      }
    const Vec2 margin{3.0, 3.0};
    low -= margin;
    const Vec2 extent = high + margin - low;
    const double cell = std::max(kFinest, std::sqrt(extent.x() * extent.y() / kMostCells));
    return {low, cell, static_cast<int>(extent.x() / cell) + 2, static_cast<int>(extent.y() / cell) + 2};
  }
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  [[nodiscard]] std::size_t of(const Vec2& place) const {
    const Vec2 cells = (place - low) / cell;
    return at(std::clamp(static_cast<int>(cells.x()), 0, width - 1),
              std::clamp(static_cast<int>(cells.y()), 0, height - 1));
  }
  [[nodiscard]] std::vector<float> distances(const std::vector<Vec2>& places) const {
    std::vector<std::uint8_t> mask(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
    for (const Vec2& place : places) mask[of(place)] = 1;
    return distance_field(mask, width, height);
  }
};

/// Lines along which a field is zero, by marching squares. The field is positive on their left.
class ZeroLines {
 public:
  ZeroLines(const Raster& raster, const std::vector<float>& field) : raster_{raster}, field_{field} {}

  /// All zero lines [m], each with true if it is closed.
  std::vector<std::pair<std::vector<Vec2>, bool>> find() {
    for (int y = 0; y + 1 < raster_.height; ++y)
      for (int x = 0; x + 1 < raster_.width; ++x) add_cell(x, y);
    std::vector<std::pair<std::vector<Vec2>, bool>> lines;
    // Open lines begin where none arrives.
    std::map<Edge, bool> arrives;
    for (const auto& [from, to] : next_) arrives[to] = true;
    std::vector<Edge> begins;
    for (const auto& [from, to] : next_)
      if (!arrives.contains(from)) begins.push_back(from);
    for (const Edge& begin : begins) lines.push_back(follow(begin));
    while (!next_.empty()) lines.push_back(follow(next_.begin()->first));
    return lines;
  }

 private:
  /// Edge of a cell: from a corner to the next one on the right (false) or above (true).
  using Edge = std::pair<std::size_t, bool>;

  [[nodiscard]] double value(int x, int y) const {
    const double v = static_cast<double>(field_[raster_.at(x, y)]);
    return v == 0.0 ? 1e-9 : v;
  }

  void add_cell(int x, int y) {
    const bool a = value(x, y) > 0.0, b = value(x + 1, y) > 0.0, c = value(x + 1, y + 1) > 0.0,
               d = value(x, y + 1) > 0.0;
    if (a == b && b == c && c == d) return;
    const Edge low{raster_.at(x, y), false}, right{raster_.at(x + 1, y), true},
        high{raster_.at(x, y + 1), false}, left{raster_.at(x, y), true};
    // Corners counter-clockwise: a line enters where positive goes to negative, and leaves where it comes
    // back.
    const bool corner[4] = {a, b, c, d};
    const Edge edges[4] = {low, right, high, left};
    std::vector<Edge> enters, leaves;
    for (int i = 0; i < 4; ++i) {
      if (corner[i] == corner[(i + 1) % 4]) continue;
      (corner[i] ? enters : leaves).push_back(edges[i]);
    }
    for (std::size_t i = 0; i < enters.size() && i < leaves.size(); ++i) next_[enters[i]] = leaves[i];
  }

  [[nodiscard]] Vec2 place(const Edge& edge) const {
    const auto columns = static_cast<std::size_t>(raster_.width);
    const int x = static_cast<int>(edge.first % columns), y = static_cast<int>(edge.first / columns);
    const double here = value(x, y);
    const double there = edge.second ? value(x, y + 1) : value(x + 1, y);
    const double share = here / (here - there);
    return raster_.low +
           raster_.cell * Vec2{x + 0.5 + (edge.second ? 0.0 : share), y + 0.5 + (edge.second ? share : 0.0)};
  }

  /// Follows an outline. `begin` is a copy, because the edge is taken out of next_.
  std::pair<std::vector<Vec2>, bool> follow(Edge begin) {
    std::vector<Vec2> line{place(begin)};
    Edge at = begin;
    for (auto step = next_.find(at); step != next_.end(); step = next_.find(at)) {
      at = step->second;
      next_.erase(step);
      if (at == begin) return {std::move(line), true};
      line.push_back(place(at));
    }
    return {std::move(line), false};
  }

  const Raster& raster_;
  const std::vector<float>& field_;
  std::map<Edge, Edge> next_;
};

/// Longest zero line near the cones. Open lines are cut off where they leave the cones.
std::optional<std::pair<std::vector<Vec2>, bool>> line_of(const Raster& raster,
                                                          const std::vector<float>& to_left,
                                                          const std::vector<float>& to_right) {
  std::vector<float> field(to_left.size());
  for (std::size_t i = 0; i < field.size(); ++i) field[i] = to_right[i] - to_left[i];
  std::optional<std::pair<std::vector<Vec2>, bool>> best;
  double most = 0.0;
  for (auto& [line, is_closed] : ZeroLines(raster, field).find()) {
    std::vector<double> room;
    for (const Vec2& point : line) room.push_back(static_cast<double>(to_left[raster.of(point)]));
    // The lower quartile is a width between cones: beyond the last ones an open line runs off to infinity.
    std::vector<double> sorted = room;
    std::sort(sorted.begin(), sorted.end());
    const double near = kFarAway * sorted[sorted.size() / 4];
    if (!is_closed) {
      std::vector<Vec2> kept, longest;
      for (std::size_t i = 0; i <= line.size(); ++i) {
        if (i < line.size() && room[i] <= near) {
          kept.push_back(line[i]);
          continue;
        }
        if (kept.size() > longest.size()) longest = kept;
        kept.clear();
      }
      line = longest;
    }
    if (line.size() < kLeastPoints) continue;
    const double length = length_of(line, is_closed);
    if (length > most) {
      most = length;
      best = {std::move(line), is_closed};
    }
  }
  return best;
}

/// Cones of one side, sorted by the nearest point of the line; cones in one place are kept once.
std::vector<Vec2> in_order(const std::vector<Vec2>& side, const std::vector<Vec2>& line) {
  std::vector<std::pair<std::ptrdiff_t, Vec2>> placed;
  for (const Vec2& cone : side) {
    const auto nearest = std::min_element(line.begin(), line.end(), [&](const Vec2& a, const Vec2& b) {
      return (a - cone).squared_norm() < (b - cone).squared_norm();
    });
    placed.emplace_back(nearest - line.begin(), cone);
  }
  std::stable_sort(placed.begin(), placed.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Vec2> ordered;
  for (const auto& [index, cone] : placed)
    if (ordered.empty() || (ordered.back() - cone).norm() > 1e-6) ordered.push_back(cone);
  return ordered;
}

void add_gaps(const std::vector<Vec2>& cones, bool is_closed, bool is_left, std::vector<ConeGap>& gaps) {
  std::vector<double> steps;
  const std::size_t count = is_closed ? cones.size() : cones.size() - 1;
  for (std::size_t i = 0; i < count; ++i) steps.push_back((cones[(i + 1) % cones.size()] - cones[i]).norm());
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double> near;
    for (std::size_t k = 1; k <= kNear && 2 * k < count; ++k) {
      if (is_closed || i + k < count) near.push_back(steps[(i + k) % count]);
      if (is_closed || i >= k) near.push_back(steps[(i + count - k) % count]);
    }
    if (!near.empty() && steps[i] > kGap * median(near))
      gaps.push_back({is_left, 0.5 * (cones[i] + cones[(i + 1) % cones.size()]), steps[i]});
  }
}

}  // namespace

Result<ConeRoad> line_between(const Cones& given) {
  Cones cones = given;
  if (cones.left.size() < 3 || cones.right.size() < 3)
    return fail(
        ErrorCode::kParse,
        fmt::format("cones: got {} of the left side and {} of the right one, expected at least 3 of each",
                    cones.left.size(), cones.right.size()));
  if (cones.left.size() + cones.right.size() + cones.either.size() > kMostCones)
    return fail(ErrorCode::kParse, fmt::format("cones: got more than {}", kMostCones));
  const Raster raster = Raster::round(cones);
  if (raster.cell * std::max(raster.width, raster.height) > kMostExtent)
    return fail(ErrorCode::kParse,
                "cones: got a place more than 20 km wide, expected cones of one course [m]");
  std::vector<float> to_left = raster.distances(cones.left);
  std::vector<float> to_right = raster.distances(cones.right);
  for (const Vec2& cone : cones.either)
    (to_left[raster.of(cone)] <= to_right[raster.of(cone)] ? cones.left : cones.right).push_back(cone);
  if (!cones.either.empty()) {
    to_left = raster.distances(cones.left);
    to_right = raster.distances(cones.right);
  }
  const auto rough = line_of(raster, to_left, to_right);
  if (!rough) return fail(ErrorCode::kParse, "cones: got no line between the two sides, expected a course");
  ConeRoad road{.is_closed = rough->second};
  const std::vector<Vec2> along = sampled(rough->first, road.is_closed, 0.5);
  const std::vector<Vec2> left = in_order(cones.left, along), right = in_order(cones.right, along);
  if (left.size() < 2 || right.size() < 2) return fail(ErrorCode::kParse, "cones: got a side in one place");
  add_gaps(left, road.is_closed, true, road.gaps);
  add_gaps(right, road.is_closed, false, road.gaps);

  // Fences between the cones, as points closer than the cells of the raster.
  to_left = raster.distances(sampled(left, road.is_closed, 0.5 * raster.cell));
  to_right = raster.distances(sampled(right, road.is_closed, 0.5 * raster.cell));
  const auto middle = line_of(raster, to_left, to_right);
  if (!middle || middle->second != road.is_closed)
    return fail(ErrorCode::kParse, "cones: got sides that cross each other, expected a course between them");
  std::vector<double> widths;
  const std::vector<Vec2> line = sampled(middle->first, road.is_closed, 0.5);
  for (const Vec2& point : line) {
    const std::size_t at = raster.of(point);
    const double to_l = std::max(0.1, static_cast<double>(to_left[at]) * raster.cell);
    const double to_r = std::max(0.1, static_cast<double>(to_right[at]) * raster.cell);
    road.points.push_back({point, to_l, to_r});
    widths.push_back(to_l + to_r);
  }
  road.median_width = median(widths);
  const auto narrowest = std::min_element(widths.begin(), widths.end());
  if (*narrowest < kLeastShare * road.median_width) {
    const Vec2& place = line[static_cast<std::size_t>(narrowest - widths.begin())];
    return fail(
        ErrorCode::kParse,
        fmt::format("cones: got a course {:.1f} m wide at ({:.2f}, {:.2f}) and {:.1f} m in the median, "
                    "expected one that does not cross itself, as a skidpad does",
                    *narrowest, place.x(), place.y(), road.median_width));
  }
  return road;
}

}  // namespace chicane::survey
