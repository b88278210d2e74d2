// SPDX-License-Identifier: MIT
// Laser scanners: beams against the walls of a road as polylines, or through the cells of an occupancy map.
#include "chicane/sim/range_scanner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "chicane/base/math.hpp"

namespace chicane::sim {
namespace {

constexpr std::size_t kPiece = 32;  // points of a wall in one circle; chosen
constexpr double kInside = 0.02;  // depth inside the road at which a wall crosses it, over its width; chosen
constexpr double kMaxWallPoints = 400'000.0;  // limit of points of both walls: bounds memory; chosen
constexpr int kMostRoom = 255;                // largest stored size of a free square: one byte [cells]
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Directions of the beams in the sensor's frame, from the right to the left.
std::vector<Vec2> directions_of(const RangeScannerOptions& options) {
  std::vector<Vec2> directions;
  for (int i = 0; i < options.beams; ++i) {
    const double angle = options.first_angle() + options.increment() * i;
    directions.emplace_back(chicane::cos(angle), chicane::sin(angle));
  }
  return directions;
}

/// Range of t in which x0 + t u lies in [0, size], for one axis; begin > end if it is empty.
struct Interval {
  double begin = -kInfinity, end = kInfinity;
};
Interval inside(double x0, double u, double size) {
  if (u == 0.0) return x0 >= 0.0 && x0 <= size ? Interval{} : Interval{kInfinity, -kInfinity};
  const double a = -x0 / u, b = (size - x0) / u;
  return {std::min(a, b), std::max(a, b)};
}

/// Number of the cell at a coordinate [cells], in [low, high]. Rounds down without std::floor, which is a
/// call on processors that lack the instruction.
int cell(double at, int low, int high) {
  const int cut = static_cast<int>(at);
  return std::clamp(at < cut ? cut - 1 : cut, low, high);
}

}  // namespace

Result<void> check(const RangeScannerOptions& options) {
  const bool is_sound = options.beams >= 2 && options.beams <= 100'000 && options.field_of_view > 0.0 &&
                        options.field_of_view <= kTwoPi && options.range_max > 0.0 && options.spacing > 0.0;
  if (!is_sound)
    return fail(
        ErrorCode::kInvalidArgument,
        "scanner: expected beams in [2, 100000], a field of view in (0, 2 pi], range and spacing > 0");
  return {};
}

Result<RangeScanner> RangeScanner::create(const road::Track& track, const RangeScannerOptions& options) {
  if (const Result<void> sound = check(options); !sound) return fail(sound.error());
  RangeScanner scanner;
  scanner.options_ = options;
  scanner.add_wall(track, 1.0);
  scanner.add_wall(track, -1.0);
  scanner.directions_ = directions_of(options);
  return scanner;
}

void RangeScanner::add_wall(const road::Track& track, double side) {
  const road::Path& centre = track.centre();
  const double step = std::max(options_.spacing, 2.0 * centre.length() / kMaxWallPoints);
  const auto count = static_cast<std::size_t>(std::ceil(centre.length() / step));
  std::size_t begin = points_.size();
  for (std::size_t i = 0; i <= count; ++i) {
    const double s = centre.length() * static_cast<double>(i) / static_cast<double>(count);
    const road::PathPoint at = centre.at(s);
    const double width = side > 0.0 ? track.left_width(s) : track.right_width(s);
    const Vec2 normal{-chicane::sin(at.heading), chicane::cos(at.heading)};
    const Vec2 point = at.position + side * (width + track.kerb_width()) * normal;
    const double inside = track.edge_distance(centre.project(point)) + track.kerb_width();
    if (inside > kInside * (width + track.kerb_width())) {
      add_pieces(begin);  // another passage of the road is here: the wall is open
      begin = points_.size();
    } else {
      points_.push_back(point);
    }
  }
  add_pieces(begin);
}

void RangeScanner::add_pieces(std::size_t begin) {
  for (std::size_t first = begin; first + 1 < points_.size(); first += kPiece - 1) {
    Piece piece{.begin = first, .end = std::min(first + kPiece, points_.size())};
    for (std::size_t i = piece.begin; i < piece.end; ++i) piece.centre += points_[i];
    piece.centre /= static_cast<double>(piece.end - piece.begin);
    for (std::size_t i = piece.begin; i < piece.end; ++i)
      piece.radius = std::max(piece.radius, (points_[i] - piece.centre).norm());
    pieces_.push_back(piece);
  }
}

void RangeScanner::scan(const model::Pose& sensor, std::span<float> ranges) const noexcept {
  std::fill(ranges.begin(), ranges.end(), std::numeric_limits<float>::infinity());
  const Vec2 here{sensor.x, sensor.y};
  for (const Piece& piece : pieces_) {
    const double reach = options_.range_max + piece.radius;
    if ((piece.centre - here).squared_norm() > reach * reach) continue;
    draw(std::span{points_}.subspan(piece.begin, piece.end - piece.begin), sensor, ranges);
  }
}

/// Each chord of the wall covers the beams between the directions of its ends.
void RangeScanner::draw(std::span<const Vec2> points, const model::Pose& sensor,
                        std::span<float> ranges) const noexcept {
  const double c = chicane::cos(sensor.psi), s = chicane::sin(sensor.psi);
  const auto in_sensor = [&](const Vec2& point) {
    const double dx = point.x() - sensor.x, dy = point.y() - sensor.y;
    return Vec2{c * dx + s * dy, c * dy - s * dx};
  };
  const double step = increment();
  const auto last = static_cast<double>(options_.beams - 1);
  const auto beam_of = [&](double angle) { return (angle - first_angle()) / step; };
  Vec2 from = in_sensor(points.front());
  double from_angle = chicane::atan2(from.y(), from.x());
  for (const Vec2& point : points.subspan(1)) {
    const Vec2 to = in_sensor(point);
    const double to_angle = chicane::atan2(to.y(), to.x());
    const double turn = wrap_angle(to_angle - from_angle);
    const Vec2 chord = to - from;
    const double numerator = cross(from, chord);
    const double begin = turn >= 0.0 ? from_angle : from_angle + turn;
    // Angles of a chord behind the sensor go beyond ± π, so that its beams are also sought one turn on and
    // back.
    for (const double lap : {0.0, kTwoPi, -kTwoPi}) {
      const double first = std::max(0.0, std::ceil(beam_of(begin + lap)));
      const double end = std::min(last, std::floor(beam_of(begin + lap + std::fabs(turn))));
      for (double k = first; k <= end; k += 1.0) {
        const auto beam = static_cast<std::size_t>(k);
        const double range = numerator / cross(directions_[beam], chord);
        if (range >= 0.0 && range <= options_.range_max)
          ranges[beam] = std::min(ranges[beam], static_cast<float>(range));
      }
    }
    from = to;
    from_angle = to_angle;
  }
}

std::vector<std::vector<Vec2>> RangeScanner::walls() const {
  std::vector<std::vector<Vec2>> walls;
  for (const Piece& piece : pieces_) {
    walls.emplace_back(points_.begin() + static_cast<std::ptrdiff_t>(piece.begin),
                       points_.begin() + static_cast<std::ptrdiff_t>(piece.end));
  }
  return walls;
}

Result<MapScanner> MapScanner::create(const OccupancyGrid& grid, const RangeScannerOptions& options) {
  if (const Result<void> sound = check(options); !sound) return fail(sound.error());
  const std::size_t cells = grid.width > 0 && grid.height > 0
                                ? static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height)
                                : 0;
  const bool is_finite =
      std::isfinite(grid.origin.x) && std::isfinite(grid.origin.y) && std::isfinite(grid.origin.psi);
  if (cells == 0 || cells > OccupancyGrid::kMostCells || grid.is_wall.size() != cells || !is_finite ||
      !(grid.resolution > 0.0 && grid.resolution < 1e6))
    return fail(ErrorCode::kInvalidArgument,
                "map: expected 1 to 64 million cells, as many values, a resolution > 0 and a finite origin");
  MapScanner scanner;
  scanner.options_ = options;
  scanner.width_ = grid.width;
  scanner.height_ = grid.height;
  scanner.resolution_ = grid.resolution;
  scanner.origin_ = grid.origin;
  scanner.axis_ = {chicane::cos(grid.origin.psi), chicane::sin(grid.origin.psi)};
  scanner.room_.resize(cells);
  std::transform(grid.is_wall.begin(), grid.is_wall.end(), scanner.room_.begin(),
                 [](bool is_wall) { return static_cast<std::uint8_t>(is_wall ? 0 : kMostRoom); });
  scanner.measure_free_room();
  scanner.directions_ = directions_of(options);
  return scanner;
}

/// Distance transform with the chessboard metric, in which a diagonal step counts one, in two passes.
void MapScanner::measure_free_room() {
  const auto relax = [&](int x, int y, int dx, int dy) {
    const int from_x = x + dx, from_y = y + dy;
    if (from_x < 0 || from_y < 0 || from_x >= width_ || from_y >= height_) return;
    const int through = room_[at(from_x, from_y)] + 1;
    if (through < room_[at(x, y)]) room_[at(x, y)] = static_cast<std::uint8_t>(through);
  };
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      relax(x, y, -1, 0);
      for (const int dx : {-1, 0, 1}) relax(x, y, dx, -1);
    }
  for (int y = height_ - 1; y >= 0; --y)
    for (int x = width_ - 1; x >= 0; --x) {
      relax(x, y, 1, 0);
      for (const int dx : {-1, 0, 1}) relax(x, y, dx, 1);
    }
}

Vec2 MapScanner::in_cells(const Vec2& place) const noexcept {
  const double dx = place.x() - origin_.x, dy = place.y() - origin_.y;
  return {(axis_.x() * dx + axis_.y() * dy) / resolution_, (axis_.x() * dy - axis_.y() * dx) / resolution_};
}

bool MapScanner::is_wall(const Vec2& place) const noexcept {
  const Vec2 cells = in_cells(place);
  const bool is_inside = cells.x() >= 0.0 && cells.y() >= 0.0 && cells.x() < width_ && cells.y() < height_;
  return is_inside && room_[at(static_cast<int>(cells.x()), static_cast<int>(cells.y()))] == 0;
}

double MapScanner::cast(const Vec2& from, const Vec2& direction) const noexcept {
  const Interval across = inside(from.x(), direction.x(), width_);
  const Interval along = inside(from.y(), direction.y(), height_);
  const double longest = std::min({across.end, along.end, options_.range_max / resolution_});
  double t = std::max({across.begin, along.begin, 0.0});
  if (t > longest) return kInfinity;
  int x = cell(from.x() + t * direction.x(), 0, width_ - 1);
  int y = cell(from.y() + t * direction.y(), 0, height_ - 1);
  const double per_x = 1.0 / direction.x(), per_y = 1.0 / direction.y();  // infinite along an axis
  while (t <= longest) {
    const int free = room_[at(x, y)];
    if (free == 0) return t;
    // Leave the square of free cells around this one, into a cell beside it.
    const int step_x = direction.x() > 0.0 ? free : -free, step_y = direction.y() > 0.0 ? free : -free;
    const double to_x =
        direction.x() == 0.0 ? kInfinity : (x + (step_x > 0 ? step_x : step_x + 1) - from.x()) * per_x;
    const double to_y =
        direction.y() == 0.0 ? kInfinity : (y + (step_y > 0 ? step_y : step_y + 1) - from.y()) * per_y;
    if (to_x <= to_y) {
      t = to_x;
      y = cell(from.y() + t * direction.y(), y - free + 1, y + free - 1);
      x += step_x;
    } else {
      t = to_y;
      x = cell(from.x() + t * direction.x(), x - free + 1, x + free - 1);
      y += step_y;
    }
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return kInfinity;
  }
  return kInfinity;
}

void MapScanner::scan(const model::Pose& sensor, std::span<float> ranges) const noexcept {
  const Vec2 here = in_cells({sensor.x, sensor.y});
  const double c = chicane::cos(sensor.psi), s = chicane::sin(sensor.psi);
  // The sensor's x axis in the axes of the map.
  const Vec2 ahead{axis_.x() * c + axis_.y() * s, axis_.x() * s - axis_.y() * c};
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const Vec2& beam = directions_[i];
    const Vec2 direction{ahead.x() * beam.x() - ahead.y() * beam.y(),
                         ahead.y() * beam.x() + ahead.x() * beam.y()};
    ranges[i] = static_cast<float>(resolution_ * cast(here, direction));
  }
}

}  // namespace chicane::sim
