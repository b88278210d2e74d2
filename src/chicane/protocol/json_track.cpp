// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <type_traits>
#include <vector>

#include "chicane/protocol/detail/foreign_roads.hpp"
#include "chicane/protocol/foreign_tracks.hpp"
#include "chicane/protocol/json.hpp"

namespace chicane::protocol {
namespace {

constexpr std::size_t kMostBytes = std::size_t{16} << 20U;

/// A member of an object or an element of a list; null where there is none.
template <typename Key>
const Json& at(const Json& json, const Key& key) {
  static const Json kNone;
  if constexpr (std::is_integral_v<Key>) {
    return json.is_array() && key < json.size() ? json[key] : kNone;
  } else {
    const auto found = json.is_object() ? json.find(key) : json.end();
    return found != json.end() ? *found : kNone;
  }
}

/// Rows of the elements of a list: of each the values behind `keys`, which name the columns.
template <typename Key>
void add_rows(const Json& list, const std::vector<Key>& keys, RoadRows& rows) {
  for (const Json& each : list) {
    std::vector<std::string> texts;
    for (const Key& key : keys) {
      const Json& value = at(each, key);
      texts.push_back(value.is_number() ? json_text(value) : value.is_null() ? "" : "something else");
    }
    rows.add(0, std::vector<std::string_view>(texts.begin(), texts.end()));
  }
}

/// ROS's messages of way points: {"centerline_waypoints": {"wpnts": [{"x_m": 1.0, …}, …]}, …}.
Result<TrackFile> track_of_way_points(const Json& root, const std::string& file,
                                      const TrackReadOptions& options) {
  RoadRows rows{
      file,
      options,
      {{"x_m", Column::kX}, {"y_m", Column::kY}, {"d_left", Column::kLeft}, {"d_right", Column::kRight}}};
  for (const char* key : {"centerline_waypoints", "global_traj_wpnts_iqp", "global_traj_wpnts_sp"}) {
    const Json& list = at(at(root, key), "wpnts");
    if (!list.is_array() || list.empty()) continue;
    rows.list = fmt::format("{}.wpnts", key);
    add_rows(list, std::vector<const char*>{"x_m", "y_m", "d_left", "d_right"}, rows);
    Result<TrackFile> content = rows.build();
    if (!content) return content;
    double width = 0.0;
    for (const road::TrackPoint& point : content->points)
      width += (point.left + point.right) / static_cast<double>(content->points.size());
    content->options.spacing = std::clamp(0.1 * width, 0.05, 2.0);
    content->options.smoothing_sigma = std::min(0.02, 0.01 * width);
    warn(*content, fmt::format("{}: taken of the file's lines", key));
    return content;
  }
  if (root.contains("X_i"))
    return fail(fault_of(file, 0, "X_i", "a track.json of MPCC, with its edges as lists of their own",
                         "a table of x_m, y_m, w_tr_right_m, w_tr_left_m"));
  return fail(fault_of(file, 0, "centerline_waypoints", "no wpnts",
                       "a list of them there or in global_traj_wpnts_iqp"));
}

/// The lines of a geometry; others are marks.
void find_lines(const Json& geometry, std::vector<const Json*>& lines) {
  const Json& type = at(geometry, "type");
  const Json& list = at(geometry, "coordinates");
  if (!list.is_array()) return;
  if (type == "LineString") lines.push_back(&list);
  if (type == "Polygon" || type == "MultiLineString")
    for (const Json& each : list)
      if (each.is_array()) lines.push_back(&each);
}

Result<TrackFile> track_of_geojson(const Json& root, const std::string& file,
                                   const TrackReadOptions& options) {
  std::vector<const Json*> lines;
  GeoLine line{file, options};
  const auto add_feature = [&](const Json& feature) {
    find_lines(at(feature, "geometry"), lines);
    const Json& width = at(at(feature, "properties"), "width");
    if (line.width == 0.0 && width.is_number()) line.width = width.get<double>();
  };
  if (const Json& features = at(root, "features"); features.is_array()) {
    for (const Json& feature : features) add_feature(feature);
  } else if (root.contains("geometry")) {
    add_feature(root);
  } else {
    find_lines(root, lines);
  }
  if (lines.empty()) return fail(fault_of(file, 0, "geometry", "no line", "a LineString or Polygon"));
  const auto longest = std::max_element(lines.begin(), lines.end(),
                                        [](const Json* a, const Json* b) { return a->size() < b->size(); });
  line.rows.list = "coordinates";
  add_rows(**longest, std::vector<std::size_t>{1, 0}, line.rows);  // latitude comes second
  Result<TrackFile> content = track_of_line(std::move(line));
  if (content && lines.size() > 1)
    warn(*content, fmt::format("geometry: the longest of {} lines taken", lines.size()));
  return content;
}

}  // namespace

Result<TrackFile> parse_json_track(std::string_view text, const std::string& file,
                                   const TrackReadOptions& options) {
  if (text.size() > kMostBytes)
    return fail(fault_of(file, 0, "file", fmt::format("{} bytes of JSON", text.size()), "at most 16 MiB"));
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  const auto root = read_json(text);
  if (!root) {
    const std::string_view read = text.substr(0, root.error().byte.value_or(0));
    return fail(fault_of(file, static_cast<int>(1 + std::count(read.begin(), read.end(), '\n')), "file",
                         "text that is no JSON", "way points or GeoJSON"));
  }
  if (!root->is_object()) return fail(fault_of(file, 1, "file", "no object", "way points or GeoJSON"));
  return root->contains("type") && !root->contains("centerline_waypoints")
             ? track_of_geojson(*root, file, options)
             : track_of_way_points(*root, file, options);
}

}  // namespace chicane::protocol
