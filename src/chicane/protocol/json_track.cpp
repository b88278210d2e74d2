// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "chicane/protocol/detail/geo_lines.hpp"
#include "chicane/protocol/detail/track_order.hpp"
#include "chicane/protocol/foreign_tracks.hpp"
#include "chicane/protocol/json.hpp"

namespace chicane::protocol {
namespace {

constexpr std::size_t kMostBytes = std::size_t{16} << 20U;

std::optional<double> number_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return std::nullopt;
  const double value = found->get<double>();
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// The list of way points behind a key, as ROS's message is written: {"wpnts": [...]}.
const Json* way_points(const Json& root, const char* key) {
  const auto found = root.find(key);
  if (found == root.end() || !found->is_object()) return nullptr;
  const auto list = found->find("wpnts");
  return list != found->end() && list->is_array() && !list->empty() ? &*list : nullptr;
}

Result<TrackFile> track_of_way_points(const Json& root, const std::string& file,
                                      const TrackReadOptions& options) {
  const char* key = "";
  const Json* list = nullptr;
  for (const char* each : {"centerline_waypoints", "global_traj_wpnts_iqp", "global_traj_wpnts_sp"}) {
    if (list != nullptr) break;
    list = way_points(root, each);
    key = each;
  }
  if (list == nullptr)
    return fail(ErrorCode::kParse, file +
                                       ": centerline_waypoints: got no wpnts, expected a list of them there "
                                       "or in global_traj_wpnts_iqp");
  TrackFile content = empty_track(file, options);
  if (list->size() > kMaxTrackPoints)
    return fail(ErrorCode::kParse,
                fmt::format("{}: {}: got {} points, expected at most 1000000", file, key, list->size()));
  std::size_t index = 0;
  for (const Json& each : *list) {
    const std::string place = fmt::format("{}: {}.wpnts[{}]", file, key, index++);
    if (!each.is_object())
      return fail(ErrorCode::kParse, place + ": got something else, expected a way point");
    const auto x = number_at(each, "x_m"), y = number_at(each, "y_m"), left = number_at(each, "d_left"),
               right = number_at(each, "d_right");
    if (!x || !y || std::fabs(*x) > road::Path::kMaxCoordinate || std::fabs(*y) > road::Path::kMaxCoordinate)
      return fail(ErrorCode::kParse,
                  place + ": x_m, y_m: got something else, expected coordinates within 1e7 m");
    const bool has_width =
        left && right && *left > 0.0 && *right > 0.0 && *left <= kMaxTrackWidth && *right <= kMaxTrackWidth;
    if (!has_width)
      return fail(ErrorCode::kParse,
                  place + ": d_left, d_right: got something else, expected widths > 0 and <= 1000 m");
    content.points.push_back({{*x, *y}, *left, *right});
  }
  settle_ends(content, options.is_closed);
  content.is_own_size = true;
  double width = 0.0;
  for (const road::TrackPoint& point : content.points)
    width += (point.left + point.right) / static_cast<double>(content.points.size());
  content.options.spacing = std::clamp(0.1 * width, 0.05, 2.0);
  content.options.smoothing_sigma = std::min(0.02, 0.01 * width);
  warn(content, fmt::format("{}: taken of the file's lines", key));
  return content;
}

/// Longitude and latitude of GeoJSON.
Result<void> add_places(const Json& list, const std::string& file, GeoLine& line) {
  for (const Json& each : list) {
    const bool is_pair = each.is_array() && each.size() >= 2 && each[0].is_number() && each[1].is_number();
    const survey::Geographic place{is_pair ? each[1].get<double>() : 1e9,
                                   is_pair ? each[0].get<double>() : 1e9};
    if (!(std::fabs(place.latitude) < 85.0 && std::fabs(place.longitude) <= 360.0))
      return fail(
          ErrorCode::kParse,
          fmt::format(
              "{}: coordinates[{}]: got something else, expected [longitude, latitude] in degrees, below 85",
              file, line.places.size()));
    line.places.push_back(place);
  }
  return {};
}

/// The lines of a geometry; others are marks.
void find_lines(const Json& geometry, std::vector<const Json*>& lines) {
  const auto type = geometry.find("type");
  const auto list = geometry.find("coordinates");
  if (type == geometry.end() || list == geometry.end() || !list->is_array()) return;
  if (*type == "LineString") lines.push_back(&*list);
  if ((*type == "Polygon" || *type == "MultiLineString") && !list->empty())
    for (const Json& each : *list)
      if (each.is_array()) lines.push_back(&each);
}

Result<TrackFile> track_of_geojson(const Json& root, const std::string& file,
                                   const TrackReadOptions& options) {
  std::vector<const Json*> lines;
  GeoLine line;
  const auto add_feature = [&](const Json& feature) {
    const auto geometry = feature.find("geometry");
    if (geometry != feature.end() && geometry->is_object()) find_lines(*geometry, lines);
    const auto properties = feature.find("properties");
    if (properties != feature.end() && properties->is_object() && line.width == 0.0)
      line.width = number_at(*properties, "width").value_or(0.0);
  };
  if (const auto features = root.find("features"); features != root.end() && features->is_array()) {
    for (const Json& feature : *features)
      if (feature.is_object()) add_feature(feature);
  } else if (root.contains("geometry")) {
    add_feature(root);
  } else {
    find_lines(root, lines);
  }
  if (lines.empty())
    return fail(ErrorCode::kParse, file + ": geometry: got no line, expected a LineString or Polygon");
  const auto longest = std::max_element(lines.begin(), lines.end(),
                                        [](const Json* a, const Json* b) { return a->size() < b->size(); });
  if (const Result<void> added = add_places(**longest, file, line); !added) return fail(added.error());
  Result<TrackFile> content = track_of_line(line, file, options);
  if (content && lines.size() > 1)
    warn(*content, fmt::format("geometry: the longest of {} lines taken", lines.size()));
  return content;
}

}  // namespace

Result<TrackFile> parse_json_track(std::string_view text, const std::string& file,
                                   const TrackReadOptions& options) {
  if (text.size() > kMostBytes)
    return fail(ErrorCode::kParse,
                fmt::format("{}: file: got {} bytes of JSON, expected at most 16 MiB", file, text.size()));
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  const auto root = read_json(text);
  if (!root) {
    const std::size_t byte = std::min(root.error().byte.value_or(0), text.size());
    return fail(
        ErrorCode::kParse,
        fmt::format("{}:{}: got text that is no JSON", file,
                    1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(byte), '\n')));
  }
  if (!root->is_object())
    return fail(ErrorCode::kParse, file + ":1: got no object, expected way points or GeoJSON");
  return root->contains("type") && !root->contains("centerline_waypoints")
             ? track_of_geojson(*root, file, options)
             : track_of_way_points(*root, file, options);
}

}  // namespace chicane::protocol
