// SPDX-License-Identifier: MIT
#include "chicane/protocol/detail/track_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace chicane::protocol {
namespace {

constexpr double kClosingCopy = 1e-3;  // a last point this near to the first repeats it [m]
constexpr double kLoopGap = 1.5;       // a loop's last gap is at most this times the longest other one

/// Twice the area that the points go round to the left [m²].
double turned_area(const std::vector<road::TrackPoint>& points) {
  double area = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 a = points[i].position - points[0].position;
    const Vec2 b = points[(i + 1) % points.size()].position - points[0].position;
    area += a.x() * b.y() - a.y() * b.x();
  }
  return area;
}

double length_of(const TrackFile& content) {
  double length =
      content.is_closed ? (content.points.front().position - content.points.back().position).norm() : 0.0;
  for (std::size_t i = 1; i < content.points.size(); ++i)
    length += (content.points[i].position - content.points[i - 1].position).norm();
  return length;
}

double way_to(const TrackFile& content, std::size_t index) {
  double length = 0.0;
  for (std::size_t i = 1; i <= index; ++i)
    length += (content.points[i].position - content.points[i - 1].position).norm();
  return length;
}

}  // namespace

TrackFile empty_track(const std::string& file, const TrackReadOptions& options) {
  TrackFile content;
  content.file = file;
  content.scale = options.scale;
  content.options.spacing *= options.scale;
  content.options.smoothing_sigma *= options.scale;
  return content;
}

void settle_ends(TrackFile& content, std::optional<bool> closed, double near) {
  std::vector<road::TrackPoint>& points = content.points;
  double longest = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i)
    longest = std::max(longest, (points[i].position - points[i - 1].position).norm());
  const double gap = (points.front().position - points.back().position).norm();
  content.is_closed = closed.value_or(gap <= std::max(near, kLoopGap * longest));
  if (!content.is_closed && !closed) {
    const std::string place =
        content.lines.empty() ? content.file : fmt::format("{}:{}", content.file, content.lines.back());
    content.warnings.push_back(
        fmt::format("{}: row: {:.1f} m from the last point to the first: read as an open road (closed=true "
                    "forces a loop)",
                    place, gap));
  }
  while (content.is_closed && points.size() > 1 &&
         (points.front().position - points.back().position).norm() < kClosingCopy) {
    points.pop_back();
    if (!content.lines.empty()) content.lines.pop_back();
  }
}

void reverse(TrackFile& content) {
  std::vector<road::TrackPoint>& points = content.points;
  if (points.size() < 2) return;
  road::TrackOptions& options = content.options;
  const double length = length_of(content);
  // A loop keeps its first point.
  const auto first = content.is_closed ? 1 : 0;
  std::reverse(points.begin() + first, points.end());
  if (content.lines.size() == points.size()) std::reverse(content.lines.begin() + first, content.lines.end());
  for (road::TrackPoint& point : points) std::swap(point.left, point.right);
  if (content.is_closed) {
    options.start_s = options.start_s != 0.0 ? length - options.start_s : 0.0;
  } else {
    // Start and finish change places.
    const double finish = options.finish_s != 0.0 ? length - options.finish_s : 0.0;
    options.finish_s = options.start_s != 0.0 ? length - options.start_s : 0.0;
    options.start_s = finish;
  }
  options.start_d = -options.start_d;
}

void begin_near(TrackFile& content, const Vec2& place) {
  std::vector<road::TrackPoint>& points = content.points;
  if (points.empty()) return;
  const auto nearest = std::min_element(points.begin(), points.end(), [&](const auto& a, const auto& b) {
    return (a.position - place).squared_norm() < (b.position - place).squared_norm();
  });
  const auto index = nearest - points.begin();
  content.options.start_d = 0.0;
  if (!content.is_closed) {
    content.options.start_s = way_to(content, static_cast<std::size_t>(index));
    return;
  }
  content.options.start_s = 0.0;
  std::rotate(points.begin(), nearest, points.end());
  if (content.lines.size() == points.size())
    std::rotate(content.lines.begin(), content.lines.begin() + index, content.lines.end());
}

void arrange(TrackFile& content, const TrackReadOptions& options) {
  using Direction = TrackReadOptions::Direction;
  const bool is_left = turned_area(content.points) > 0.0;
  const bool turns = options.direction == Direction::kReversed ||
                     (options.direction == Direction::kLeft && !is_left) ||
                     (options.direction == Direction::kRight && is_left);
  if (turns) reverse(content);
  if (options.start) begin_near(content, *options.start);
  if (options.smoothing_sigma) content.options.smoothing_sigma = *options.smoothing_sigma;
}

void assume_width(TrackFile& content, const TrackReadOptions& options) {
  const double left = options.scale * options.default_left, right = options.scale * options.default_right;
  for (road::TrackPoint& point : content.points) {
    point.left = left;
    point.right = right;
  }
  warn(content,
       fmt::format("width: not in the file, {} m left and {} m right assumed (import --width-m sets it)",
                   left, right));
}

void warn(TrackFile& content, std::string_view what) {
  content.warnings.push_back(fmt::format("{}: {}", content.file, what));
}

}  // namespace chicane::protocol
