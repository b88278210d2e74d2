// SPDX-License-Identifier: MIT
// Occupancy maps of ROS: YAML and image, their cells, and the road in them.
#include "chicane/protocol/occupancy_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "chicane/base/text.hpp"
#include "chicane/protocol/detail/road_rows.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/track_codec.hpp"
#include "chicane/protocol/yaml_codec.hpp"

namespace chicane::protocol {
namespace {

/// Sets start and direction of a road without options for them. The start is the map's origin if that is on
/// the road, and the direction there is that of +x: the origin of a map is the robot's first pose.
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

Result<OccupancyMap> parse_map(std::string_view text, const std::string& file) {
  const Result<YamlTree> tree = parse_yaml(text, file);
  if (!tree) return fail(tree.error());
  OccupancyMap map;
  YamlReader reader(file);
  std::string image_file, mode;
  std::vector<double> origin;
  const auto take_origin = [&](const YamlNode& node) {
    constexpr std::array kNames{"origin: x", "origin: y", "origin: yaw"};
    const auto number = number_in(node.text);
    if (!number)
      return reader.refuse(node, kNames[std::min<std::size_t>(origin.size(), 2)], "a finite number");
    origin.push_back(*number);
  };
  const auto take_negate = [&](const YamlEntry& entry) {
    double negate = entry.value.text == "true" ? 1.0 : 0.0;
    if (entry.value.text != "true" && entry.value.text != "false") reader.number(negate, 0.0, 1.0)(entry);
    map.is_negated = negate != 0.0;
  };
  reader.read_map(*tree->root, "file", "a map with image, resolution and origin, as map_server has it",
                  {{"image", reader.text(image_file)},
                   {"resolution", reader.number(map.resolution, 1e-4, 100.0)},
                   {"occupied_thresh", reader.number(map.occupied, 0.0, 1.0)},
                   {"free_thresh", reader.number(map.free, 0.0, 1.0)},
                   {"origin", reader.list("numbers: [x, y, yaw]", take_origin, 3)},
                   {"mode", reader.choice(mode, {"trinary", "scale"})},
                   {"negate", take_negate}},
                  YamlReader::Others::kIgnored);
  if (reader.is_faultless()) {
    if (image_file.empty()) reader.fault(1, "image", "got none, expected the name of a PGM or PNG file");
    if (map.resolution <= 0.0) reader.fault(1, "resolution", "got none, expected the side of a cell > 0 m");
    if (origin.size() < 2) reader.fault(1, "origin", "got none, expected [x, y, yaw]");
  }
  if (!reader.is_faultless()) return fail(reader.error());
  map.origin = {origin[0], origin[1]};
  map.yaw = origin.size() > 2 ? origin[2] : 0.0;
  const std::string path = (std::filesystem::path(file).parent_path() / image_file).string();
  const Result<std::string> bytes = read_file(path);
  if (!bytes)
    return fail(fault_of(file, 0, "image", fmt::format("{}, which cannot be read", printable(image_file)),
                         "a PGM or PNG file beside the map"));
  Result<survey::GreyImage> image = survey::read_image(*bytes, path);
  if (!image) return fail(image.error());
  map.image = std::move(*image);
  return map;
}

Result<OccupancyMap> read_map(const std::string& file) {
  const Result<std::string> text = read_file(file);
  return text ? parse_map(*text, file) : fail(text.error());
}

survey::FreeSpace free_space_of(const OccupancyMap& map) {
  survey::FreeSpace space{.width = map.image.width,
                          .height = map.image.height,
                          .resolution = map.resolution,
                          .origin = map.origin,
                          .yaw = map.yaw};
  space.cells.reserve(map.image.values.size());
  for (int y = map.image.height - 1; y >= 0; --y)  // from the bottom: rows of the image begin at the top
    for (int x = 0; x < map.image.width; ++x) {
      const double dark = map.darkness(x, y);
      if (map.is_unknown(x, y)) {
        space.cells.push_back(survey::Cell::kUnknown);
        continue;
      }
      space.cells.push_back(dark > map.occupied ? survey::Cell::kWall
                            : dark < map.free   ? survey::Cell::kFree
                                                : survey::Cell::kUnknown);
    }
  return space;
}

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
  // Derived: walls are known to a cell, so that the line between them scatters by less than a cell. Chosen:
  // spacing.
  content.options.smoothing_sigma = std::min(map->resolution, 0.1);
  content.options.spacing = std::clamp(0.1 * loop->median_width, 0.05, 2.0);
  if (loop->spots > 0)
    warn(content, fmt::format("free space: {} spots below 0.25 m taken for noise of the map", loop->spots));
  begin_at_origin(content, options, loop->median_width);
  return content;
}

}  // namespace chicane::protocol
