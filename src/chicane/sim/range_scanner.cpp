// SPDX-License-Identifier: MIT
#include "chicane/sim/range_scanner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "chicane/base/angle.hpp"
#include "chicane/base/math.hpp"

namespace chicane::sim {
namespace {

constexpr std::size_t kPiece = 32;  // points of a wall in one circle
constexpr double kInside = 0.02;    // share of the road's width: a wall so far inside crosses the road
constexpr double kTwoPi = 2.0 * 3.14159265358979323846;
constexpr double kMaxWallPoints = 400'000.0;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

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
  for (int i = 0; i < options.beams; ++i) {
    const double angle = scanner.first_angle() + scanner.increment() * i;
    scanner.directions_.emplace_back(chicane::cos(angle), chicane::sin(angle));
  }
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

/// The points from `begin` on are one wall without a gap.
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

/// Each chord of the wall covers the beams between the directions of its ends; the nearest wall is seen.
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
    // Behind the sensor the angles go on past a half turn: the beams there are met one turn on, too.
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

}  // namespace chicane::sim
