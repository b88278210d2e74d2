// SPDX-License-Identifier: MIT
// Rows of a road's file: checks each point, arranges direction and start, and builds the road.
#include "chicane/protocol/detail/road_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "chicane/base/text.hpp"
#include "chicane/protocol/csv_text.hpp"
#include "chicane/survey/sampled_line.hpp"

namespace chicane::protocol {
namespace {

// Limit of the gap from a closed road's last point to its first, over the longest other gap; chosen.
constexpr double kLoopGap = 1.5;

/// Allowed values of a column.
struct Range {
  double least, most;
  std::string_view expected;
};
constexpr Range range_of(Column column) {
  switch (column) {
    case Column::kLongitude:
      return {-360.0, 360.0, "degrees of longitude"};
    case Column::kLatitude:
      return {-85.0, 85.0, "degrees of latitude, at most 85"};
    case Column::kX:
    case Column::kY:
      return {-road::Path::kMaxCoordinate, road::Path::kMaxCoordinate, "a coordinate within 1e7 m"};
    default:
      return {std::numeric_limits<double>::denorm_min(), kMaxTrackWidth, "a width > 0 and <= 1000 m"};
  }
}

/// Beginning of a message: "FILE:LINE: ", or "FILE: ".
std::string place_of(std::string_view file, int line) {
  return line > 0 ? fmt::format("{}:{}: ", file, line) : fmt::format("{}: ", file);
}

std::vector<Vec2> places_of(const TrackFile& content) {
  std::vector<Vec2> places;
  for (const road::TrackPoint& point : content.points) places.push_back(point.position);
  return places;
}

}  // namespace

Error fault_of(std::string_view file, int line, std::string_view key, std::string_view got,
               std::string_view expected) {
  return {ErrorCode::kParse,
          fmt::format("{}{}: got {}, expected {}", place_of(file, line), key, got, expected)};
}

void warn(TrackFile& content, std::string_view what, int line) {
  content.warnings.push_back(place_of(content.file, line).append(what));
}

void warn_of_width(TrackFile& content, const TrackReadOptions& options, int line) {
  warn(content,
       fmt::format("width: not in the file, {} m left and {} m right assumed (import --width-m sets it)",
                   options.scale * options.default_left, options.scale * options.default_right),
       line);
}

void reverse(TrackFile& content) {
  std::vector<road::TrackPoint>& points = content.points;
  if (points.size() < 2) return;
  road::TrackOptions& options = content.options;
  const double length = survey::length_of(places_of(content), content.is_closed);
  // The first point of a closed road stays the first.
  const auto first = content.is_closed ? 1 : 0;
  std::reverse(points.begin() + first, points.end());
  if (content.lines.size() == points.size()) std::reverse(content.lines.begin() + first, content.lines.end());
  for (road::TrackPoint& point : points) std::swap(point.left, point.right);
  const auto turned = [&](double s) { return s != 0.0 ? length - s : 0.0; };
  options.start_s = turned(options.start_s);
  if (!content.is_closed) {
    options.finish_s = turned(options.finish_s);
    std::swap(options.start_s, options.finish_s);
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
  content.options.start_s = content.options.start_d = 0.0;
  if (!content.is_closed) {
    const std::vector<Vec2> places = places_of(content);
    content.options.start_s = survey::length_of({places.data(), static_cast<std::size_t>(index) + 1}, false);
    return;
  }
  std::rotate(points.begin(), nearest, points.end());
  if (content.lines.size() == points.size())
    std::rotate(content.lines.begin(), content.lines.begin() + index, content.lines.end());
}

void arrange(TrackFile& content, const TrackReadOptions& options) {
  using Direction = TrackReadOptions::Direction;
  const bool is_left = survey::signed_area(places_of(content)) > 0.0;
  const bool turns = options.direction == Direction::kReversed ||
                     (options.direction == Direction::kLeft && !is_left) ||
                     (options.direction == Direction::kRight && is_left);
  if (turns) reverse(content);
  if (options.start) begin_near(content, *options.start);
  if (options.smoothing_sigma) content.options.smoothing_sigma = *options.smoothing_sigma;
}

RoadRows::RoadRows(const std::string& file, const TrackReadOptions& read_options, std::vector<Named> named)
    : options{read_options}, columns{std::move(named)} {
  content.file = file;
  content.scale = options.scale;
  content.options.spacing *= options.scale;
  content.options.smoothing_sigma *= options.scale;
}

bool RoadRows::has(Column column) const {
  return std::any_of(columns.begin(), columns.end(),
                     [&](const Named& each) { return each.column == column; });
}

void RoadRows::fault(int line, std::string_view key, std::string_view got, std::string_view expected) {
  if (error) return;
  error = list.empty() ? fault_of(content.file, line, key, got, expected)
                       : fault_of(content.file, 0,
                                  fmt::format("{}[{}]: {}", list, content.points.size(), key), got, expected);
}

void RoadRows::add(const road::TrackPoint& point) {
  if (content.points.size() == kMaxTrackPoints) return fault(0, "road", "another point", "at most 1000000");
  content.points.push_back(point);
}

void RoadRows::add(int line, std::span<const std::string_view> cells, char separator) {
  if (error) return;
  if (cells.size() < columns.size())
    return fault(line, "row", fmt::format("{} columns", cells.size()), fmt::format("{}", columns.size()));
  if (content.points.size() == kMaxTrackPoints) return fault(line, "row", "another point", "at most 1000000");
  road::TrackPoint point{{}, options.scale * options.default_left, options.scale * options.default_right};
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Column column = columns[i].column;
    if (column == Column::kSkipped || column == Column::kUnknown) continue;
    if (column == Column::kTag) {
      tags.push_back(lower(cells[i]));
      continue;
    }
    const std::optional<double> value = number(cells[i], separator);
    if (column == Column::kHeading) {
      headings.push_back(value.value_or(0.0));
      continue;
    }
    const Range range = range_of(column);
    if (!value)
      return fault(line, columns[i].name, printable(cells[i]), "a finite number with a decimal point");
    if (!(*value >= range.least && *value <= range.most))
      return fault(line, columns[i].name, printable(cells[i]), range.expected);
    if (column == Column::kX || column == Column::kLongitude) point.position.x() = *value;
    if (column == Column::kY || column == Column::kLatitude) point.position.y() = *value;
    if (column == Column::kLeft) point.left = *value;
    if (column == Column::kRight) point.right = *value;
    if (column == Column::kWidth && !has(Column::kRight)) point.left = point.right = 0.5 * *value;
  }
  content.points.push_back(point);
  if (line > 0) content.lines.push_back(line);
}

void RoadRows::expect_points(std::size_t least) {
  if (content.points.size() < least)
    fault(0, "points", fmt::format("{}", content.points.size()), fmt::format("at least {}", least));
}

Result<TrackFile> RoadRows::build() {
  expect_points(1);
  if (error) return fail(std::move(*error));
  std::vector<road::TrackPoint>& points = content.points;
  const auto gap = [&] { return (points.front().position - points.back().position).norm(); };
  double longest = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i)
    longest = std::max(longest, (points[i].position - points[i - 1].position).norm());
  content.is_closed = closed.value_or(gap() <= std::max(meets, kLoopGap * longest));
  if (!content.is_closed && !closed) {
    warn(content,
         fmt::format(
             "row: {:.1f} m from the last point to the first: read as an open road (closed=true forces "
             "a loop)",
             gap()),
         content.lines.empty() ? 0 : content.lines.back());
  }
  while (content.is_closed && points.size() > 1 && gap() < kClosingCopy) {
    points.pop_back();
    if (!content.lines.empty()) content.lines.pop_back();
  }
  return std::move(content);
}

}  // namespace chicane::protocol
