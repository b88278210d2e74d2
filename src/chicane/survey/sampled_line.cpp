// SPDX-License-Identifier: MIT
// Geometry of surveyed points: polylines, the plane of geographic coordinates, and the road between cones.
// The road's line is the zero line of a field on a raster: distance to the right cones less distance to the
// left.
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
#include "chicane/base/median.hpp"
#include "chicane/survey/image.hpp"

namespace chicane::survey {

double length_of(std::span<const Vec2> line, bool closed) noexcept {
  double length = closed && !line.empty() ? (line.front() - line.back()).norm() : 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

std::vector<Vec2> sampled(std::span<const Vec2> line, bool closed, double spacing) {
  constexpr double kMost = 1e6;  // limit of points: bounds memory; chosen
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
constexpr double kFinest = 0.05;           // [m] least side of a cell; chosen
constexpr double kGap = 1.6;         // length of a reported gap over the median of its neighbours; chosen
constexpr std::size_t kNear = 4;     // neighbours on each side that a gap is compared with; chosen
constexpr double kLeastShare = 0.2;  // narrowest width of a course over the median one; chosen
constexpr double kFarAway = 3.0;  // distance to the cones that ends a line, over its lower quartile; chosen
constexpr std::size_t kLeastPoints = 8;  // points of a zero line that is no noise; chosen
constexpr double kSpacing = 0.5;         // [m] spacing of the road's points, as in ConeRoad

/// Grid of square cells round the cones.
struct Raster : Grid {
  Vec2 low{};         ///< lower left corner of the first cell [m]
  double cell = 0.1;  ///< side of a cell [m]

  /// Raster with a margin round the cones, as fine as kMostCells permits.
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
    return {{static_cast<int>(extent.x() / cell) + 2, static_cast<int>(extent.y() / cell) + 2}, low, cell};
  }
  /// Index of the cell at a position [m], or of the nearest one.
  [[nodiscard]] std::size_t cell_at(const Vec2& position) const {
    const Vec2 cells = (position - low) / cell;
    return at(std::clamp(static_cast<int>(cells.x()), 0, width - 1),
              std::clamp(static_cast<int>(cells.y()), 0, height - 1));
  }
  /// Distance of each cell to the nearest of some positions [cells].
  [[nodiscard]] std::vector<float> distances(const std::vector<Vec2>& positions) const {
    Mask mask(size(), 0);
    for (const Vec2& position : positions) mask[cell_at(position)] = 1;
    return distance_field(mask, width, height);
  }
};

/// Line along which a field is zero [m].
struct ZeroLine {
  std::vector<Vec2> points = {};
  bool is_closed = false;
};

/// Search of the lines along which a field is zero, by marching squares. The field is positive on their left.
class ZeroLines {
 public:
  ZeroLines(const Raster& raster, const std::vector<float>& field) : raster_{raster}, field_{field} {}

  /// All zero lines.
  std::vector<ZeroLine> find() {
    for (int y = 0; y + 1 < raster_.height; ++y)
      for (int x = 0; x + 1 < raster_.width; ++x) add_cell(x, y);
    std::vector<ZeroLine> lines;
    // An open line begins at an edge that no other piece leads to.
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

  /// The field at the centre of a cell; never zero, so that each line lies between two centres.
  [[nodiscard]] double value(int x, int y) const {
    const double v = static_cast<double>(field_[raster_.at(x, y)]);
    return v == 0.0 ? 1e-9 : v;
  }

  /// Adds the pieces of zero lines in the square between the centres of four cells, of which (x, y) is the
  /// lowest and leftmost.
  void add_cell(int x, int y) {
    const bool a = value(x, y) > 0.0, b = value(x + 1, y) > 0.0, c = value(x + 1, y + 1) > 0.0,
               d = value(x, y + 1) > 0.0;
    if (a == b && b == c && c == d) return;
    const Edge low{raster_.at(x, y), false}, right{raster_.at(x + 1, y), true},
        high{raster_.at(x, y + 1), false}, left{raster_.at(x, y), true};
    // Corners counter-clockwise: a line enters through an edge from positive to negative, and leaves through
    // one from negative to positive.
    const bool corner[4] = {a, b, c, d};
    const Edge edges[4] = {low, right, high, left};
    std::vector<Edge> enters, leaves;
    for (int i = 0; i < 4; ++i) {
      if (corner[i] == corner[(i + 1) % 4]) continue;
      (corner[i] ? enters : leaves).push_back(edges[i]);
    }
    for (std::size_t i = 0; i < enters.size() && i < leaves.size(); ++i) next_[enters[i]] = leaves[i];
  }

  /// Position of the zero on an edge [m], by linear interpolation.
  [[nodiscard]] Vec2 zero_on(const Edge& edge) const {
    const auto [x, y] = raster_.place(edge.first);
    const double here = value(x, y);
    const double there = edge.second ? value(x, y + 1) : value(x + 1, y);
    const double share = here / (here - there);
    return raster_.low +
           raster_.cell * Vec2{x + 0.5 + (edge.second ? 0.0 : share), y + 0.5 + (edge.second ? share : 0.0)};
  }

  /// Takes the line from the edge `begin` on out of next_. `begin` is a copy, because next_ loses the edge.
  ZeroLine follow(Edge begin) {
    std::vector<Vec2> line{zero_on(begin)};
    Edge at = begin;
    for (auto step = next_.find(at); step != next_.end(); step = next_.find(at)) {
      at = step->second;
      next_.erase(step);
      if (at == begin) return {std::move(line), true};
      line.push_back(zero_on(at));
    }
    return {std::move(line), false};
  }

  const Raster& raster_;
  const std::vector<float>& field_;
  std::map<Edge, Edge> next_;  ///< the edge through which a line leaves, for each through which it enters
};

/// Longest zero line near the cones; empty if there is none. Open lines are cut off where they leave the
/// cones. `to_left`, `to_right`: distances to the cones of a side [cells].
ZeroLine line_of(const Raster& raster, const std::vector<float>& to_left,
                 const std::vector<float>& to_right) {
  std::vector<float> field(to_left.size());
  for (std::size_t i = 0; i < field.size(); ++i) field[i] = to_right[i] - to_left[i];
  ZeroLine best;
  double most = 0.0;
  for (auto& [line, is_closed] : ZeroLines(raster, field).find()) {
    std::vector<double> room;
    for (const Vec2& point : line) room.push_back(static_cast<double>(to_left[raster.cell_at(point)]));
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

/// Cones of one side, sorted along the line by its point nearest to each. Of cones in one place one is kept.
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

/// Adds the gaps between the cones of one side that are much longer than those beside them.
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
    if (!near.empty() && steps[i] > kGap * median(std::move(near)))
      gaps.push_back({is_left, 0.5 * (cones[i] + cones[(i + 1) % cones.size()]), steps[i]});
  }
}

/// Sets the points of the road and its median width, from the distances to its edges [cells]. Fails for a
/// line with a place much narrower than the others: there the course crosses itself.
Result<void> add_points(const std::vector<Vec2>& line, const Raster& raster,
                        const std::vector<float>& to_left, const std::vector<float>& to_right,
                        ConeRoad& road) {
  std::vector<double> widths;
  for (const Vec2& point : line) {
    const std::size_t at = raster.cell_at(point);
    const double left = std::max(0.1, static_cast<double>(to_left[at]) * raster.cell);
    const double right = std::max(0.1, static_cast<double>(to_right[at]) * raster.cell);
    road.points.push_back({point, left, right});
    widths.push_back(left + right);
  }
  road.median_width = median(widths);
  const auto narrowest = std::min_element(widths.begin(), widths.end());
  if (*narrowest >= kLeastShare * road.median_width) return {};
  const Vec2& place = line[static_cast<std::size_t>(narrowest - widths.begin())];
  return fail(ErrorCode::kParse,
              fmt::format("cones: got a course {:.1f} m wide at ({:.2f}, {:.2f}) and {:.1f} m in the median, "
                          "expected one that does not cross itself, as a skidpad does",
                          *narrowest, place.x(), place.y(), road.median_width));
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
    (to_left[raster.cell_at(cone)] <= to_right[raster.cell_at(cone)] ? cones.left : cones.right)
        .push_back(cone);
  if (!cones.either.empty()) {
    to_left = raster.distances(cones.left);
    to_right = raster.distances(cones.right);
  }

  // The line halfway between single cones, and the order of the cones along it.
  const ZeroLine rough = line_of(raster, to_left, to_right);
  if (rough.points.empty())
    return fail(ErrorCode::kParse, "cones: got no line between the two sides, expected a course");
  ConeRoad road{.is_closed = rough.is_closed};
  const std::vector<Vec2> along = sampled(rough.points, road.is_closed, kSpacing);
  const std::vector<Vec2> left = in_order(cones.left, along), right = in_order(cones.right, along);
  if (left.size() < 2 || right.size() < 2) return fail(ErrorCode::kParse, "cones: got a side in one place");
  add_gaps(left, road.is_closed, true, road.gaps);
  add_gaps(right, road.is_closed, false, road.gaps);

  // The line halfway between the fences that join the cones, which are points closer than the raster's cells.
  to_left = raster.distances(sampled(left, road.is_closed, 0.5 * raster.cell));
  to_right = raster.distances(sampled(right, road.is_closed, 0.5 * raster.cell));
  const ZeroLine middle = line_of(raster, to_left, to_right);
  if (middle.points.empty() || middle.is_closed != road.is_closed)
    return fail(ErrorCode::kParse, "cones: got sides that cross each other, expected a course between them");
  const std::vector<Vec2> line = sampled(middle.points, road.is_closed, kSpacing);
  if (const Result<void> sound = add_points(line, raster, to_left, to_right, road); !sound)
    return fail(sound.error());
  return road;
}

}  // namespace chicane::survey
