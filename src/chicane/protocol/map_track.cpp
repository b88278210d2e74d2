// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chicane/protocol/detail/road_rows.hpp"
#include "chicane/protocol/foreign_tracks.hpp"
#include "chicane/protocol/occupancy_map.hpp"

namespace chicane::protocol {
namespace {

/// Maps count from where the robot stood when it began, looking along +x: where that is on the road, it is
/// the start, and its direction that of the road.
void begin_at_origin(TrackFile& content, const TrackReadOptions& options, double width) {
  const Vec2 origin{};
  double nearest = 1e9;
  for (const road::TrackPoint& point : content.points)
    nearest = std::min(nearest, (point.position - origin).norm());
  const bool is_on_road = nearest < 0.5 * width;
  begin_near(content, options.start.value_or(is_on_road ? origin : content.points.front().position));
  const Vec2 along = content.points[1].position - content.points[0].position;
  const bool looks_along = std::fabs(along.x()) > 0.7 * along.norm();
  if (options.direction != TrackReadOptions::Direction::kOfTheFile) return;
  const bool follows_origin = is_on_road && !options.start && looks_along;
  if (follows_origin && along.x() < 0.0) reverse(content);
  warn(content,
       fmt::format(
           "direction: {} (import --direction sets it), from ({:.2f}, {:.2f}) (import --start sets it)",
           follows_origin ? "not in a map, that of the map's origin assumed"
                          : "not in a map, counter-clockwise assumed",
           content.points.front().position.x(), content.points.front().position.y()));
}

}  // namespace

Result<TrackFile> parse_map_track(std::string_view text, const std::string& file,
                                  const TrackReadOptions& options) {
  if (text.starts_with("\x89PNG") || text.starts_with("P5") || text.starts_with("P2"))
    return fail(fault_of(file, 0, "file", "an image", "the YAML file beside it that says its resolution"));
  const Result<OccupancyMap> map = parse_map(text, file);
  if (!map) return fail(map.error());
  Result<survey::FreeLoop> loop =
      survey::find_loop(free_space_of(*map), {.least_width = options.least_width, .start = options.start});
  if (!loop) return fail(loop.error().code, file + ": " + loop.error().message);
  TrackFile content = RoadRows{file, options}.content;
  content.points = std::move(loop->points);
  content.is_closed = true;
  content.is_own_size = true;
  // Walls are where cells end: a line between them scatters by less than a cell.
  content.options.smoothing_sigma = std::min(map->resolution, 0.1);
  content.options.spacing = std::clamp(0.1 * loop->median_width, 0.05, 2.0);
  if (loop->spots > 0)
    warn(content, fmt::format("free space: {} spots below 0.25 m taken for noise of the map", loop->spots));
  begin_at_origin(content, options, loop->median_width);
  return content;
}

}  // namespace chicane::protocol
