// SPDX-License-Identifier: MIT
// Roads of other programs, recognised by their content: the list of formats, then cones (CSV, YAML, SDF) and
// JSON (way points of ROS, GeoJSON). Maps, XML of roads and coordinates have files of their own.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "chicane/base/text.hpp"
#include "chicane/protocol/csv_text.hpp"
#include "chicane/protocol/detail/foreign_roads.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/protocol/track_codec.hpp"
#include "chicane/protocol/yaml_tree.hpp"
#include "chicane/survey/sampled_line.hpp"

namespace chicane::protocol {
namespace {

constexpr std::size_t kHead = 4096;  // [byte] from a file's beginning that decide on its format; chosen

/// First kHead bytes of a text, without byte-order mark and leading blanks.
std::string_view head_of(std::string_view text) noexcept {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  text = text.substr(0, kHead);
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  return begin == std::string_view::npos ? std::string_view{} : text.substr(begin);
}

/// Whether a line of the head begins with the key of a YAML map.
bool has_key(std::string_view head, std::string_view key) noexcept {
  for (std::size_t at = head.find(key); at != std::string_view::npos; at = head.find(key, at + 1)) {
    const std::size_t end = at + key.size();
    if ((at == 0 || head[at - 1] == '\n') && end < head.size() && head[end] == ':') return true;
  }
  return false;
}

/// Whether a text is an occupancy map of ROS's map_server: its YAML, or the image.
bool is_map(std::string_view text) noexcept {
  if (text.starts_with("\x89PNG") || text.starts_with("P5\n") || text.starts_with("P2\n")) return true;
  const std::string_view head = head_of(text);
  return has_key(head, "image") && has_key(head, "resolution");
}

bool is_xml(std::string_view text) noexcept {
  const std::string_view head = head_of(text);
  return head.size() > 1 && head[0] == '<' &&
         (head[1] == '?' || head[1] == '!' || (head[1] >= 'A' && head[1] <= 'z'));
}

/// Whether a text is a JSON object of a known kind: GeoJSON, or way points of the ForzaETH race stack.
bool is_json(std::string_view text) noexcept {
  const std::string_view head = head_of(text);
  if (head.empty() || head[0] != '{') return false;
  const std::string_view body = text.substr(0, std::size_t{1} << 20U);
  const auto has = [&](std::string_view word) { return body.find(word) != std::string_view::npos; };
  return has("\"type\"") || has("wpnts") || has("map_info_str") || has("\"X_i\"");
}

bool is_yaml_cones(std::string_view text) noexcept {
  const std::string_view head = head_of(text);
  return has_key(head, "cones_left") || has_key(head, "cones_right");
}

/// Whether a text is a table of cones: its first row of numbers names a colour.
bool is_csv_cones(std::string_view text) noexcept {
  constexpr std::string_view kColours = " blue yellow blue_cone yellow_cone cone_blue cone_yellow ";
  constexpr int kMostRows = 4;
  CsvLines lines(head_of(text));
  int rows = 0;
  for (auto line = lines.next(); line && rows < kMostRows; line = lines.next()) {
    rows += line->empty() ? 0 : 1;
    if (line->empty() || line->front() == '#' || line->front() == '%') continue;
    int numbers = 0;
    bool has_colour = false;
    for (const std::string_view field : split(*line, separator_of(*line))) {
      const std::string word = lower(field);
      numbers += number(field) ? 1 : 0;
      has_colour |= word.find("orange") != std::string::npos || is_among(word, kColours);
    }
    if (numbers >= 2) return has_colour;
  }
  return false;
}

constexpr std::array kForeign{
    TrackFormat{"", &parse_map_track, &is_map},       TrackFormat{"", &parse_xml_track, &is_xml},
    TrackFormat{"", &parse_json_track, &is_json},     TrackFormat{"", &parse_yaml_cones, &is_yaml_cones},
    TrackFormat{"", &parse_csv_cones, &is_csv_cones},
};

Result<TrackFile> refuse_commonroad(const XmlDocument& xml, const TrackReadOptions&) {
  return fail(fault_of(xml.file, xml.line_of(xml.root()), "root", "a scene of CommonRoad",
                       "one road, such as points of its line: lanelets are not read"));
}

/// Kind of XML file, by its root element.
struct Dialect {
  std::string_view tag, kind;
  Result<TrackFile> (*read)(const XmlDocument&, const TrackReadOptions&);
};
constexpr std::array kDialects{
    Dialect{"<gpx", "GPX", &track_of_gpx},
    Dialect{"<kml", "KML", &track_of_kml},
    Dialect{"<osm", "OpenStreetMap", &track_of_osm},
    Dialect{"<OpenDRIVE", "OpenDRIVE", &track_of_opendrive},
    Dialect{"<commonRoad", "CommonRoad", &refuse_commonroad},
    Dialect{"<sdf", "cones (SDF)", &track_of_sdf},
};

}  // namespace

std::span<const TrackFormat> foreign_tracks() noexcept { return kForeign; }

std::string_view road_kind(std::string_view text) noexcept {
  if (is_map(text)) return "occupancy map";
  if (is_yaml_cones(text) || is_csv_cones(text)) return "cones";
  if (is_json(text)) return text.find("wpnts") != std::string_view::npos ? "ForzaETH way points" : "GeoJSON";
  if (!is_xml(text)) return "table of points";
  for (const Dialect& dialect : kDialects)
    if (text.substr(0, kHead).find(dialect.tag) != std::string_view::npos) return dialect.kind;
  return "XML";
}

Result<TrackFile> parse_xml_track(std::string_view text, const std::string& file,
                                  const TrackReadOptions& options) {
  const Result<XmlDocument> xml = parse_xml(text, file);
  if (!xml) return fail(xml.error());
  const std::string_view root = xml->root().name();
  for (const Dialect& dialect : kDialects)
    if (root == dialect.tag.substr(1)) return dialect.read(*xml, options);
  return fail(fault_of(file, xml->line_of(xml->root()), "root",
                       fmt::format("the element {}", printable(root)), "gpx, kml, osm, OpenDRIVE or sdf"));
}

namespace {

constexpr std::size_t kMostNamed = 5;  // gaps in warnings; chosen

/// Rows of cones: position and tag.
RoadRows cone_rows(const std::string& file, const TrackReadOptions& options) {
  return {file, options, {{"x", Column::kX}, {"y", Column::kY}, {"tag", Column::kTag}}};
}

/// Cones by their tags in files: "blue", "cone_yellow", "big_orange", "left". Blue is left, yellow right, as
/// in Formula Student.
struct ConeMap {
  survey::Cones cones;
  std::optional<Vec2> start{};  ///< start of the car, if the file has it
  int unknown = 0;              ///< cones whose colour names no side

  void add(std::string_view tag, const Vec2& place) {
    const auto has = [&](std::string_view word) { return tag.find(word) != std::string_view::npos; };
    if (has("orange")) {
      cones.either.push_back(place);
    } else if (has("blue") || tag == "left" || tag == "b") {
      cones.left.push_back(place);
    } else if (has("yellow") || tag == "right" || tag == "y") {
      cones.right.push_back(place);
    } else if (has("start")) {
      start = place;
    } else {
      ++unknown;
    }
  }
};

/// The road between cones, with a warning for each gap.
Result<TrackFile> track_of_cones(const RoadRows& rows) {
  if (rows.error) return fail(*rows.error);
  ConeMap map;
  for (std::size_t i = 0; i < rows.tags.size(); ++i) map.add(rows.tags[i], rows.content.points[i].position);
  const std::string& file = rows.content.file;
  Result<survey::ConeRoad> road = survey::line_between(map.cones);
  if (!road) return fail(road.error().code, file + ": " + road.error().message);
  TrackFile content = RoadRows{file, rows.options}.content;
  content.points = std::move(road->points);
  content.is_closed = road->is_closed;
  // Chosen: noise of placed cones, and a spacing that follows bends of roads of any scale.
  content.options.smoothing_sigma = std::min(0.1, 0.05 * road->median_width);
  content.options.spacing = std::clamp(0.2 * road->median_width, 0.05, 2.0);
  for (std::size_t i = 0; i < road->gaps.size() && i < kMostNamed; ++i) {
    const survey::ConeGap& gap = road->gaps[i];
    warn(content,
         fmt::format(
             "cones: none on the {} side for {:.1f} m round ({:.2f}, {:.2f}): joined by a straight fence",
             gap.is_left ? "left" : "right", gap.length, gap.place.x(), gap.place.y()));
  }
  if (road->gaps.size() > kMostNamed)
    warn(content, fmt::format("cones: {} gaps more", road->gaps.size() - kMostNamed));
  if (map.unknown > 0) warn(content, fmt::format("cones: {} of other colours ignored", map.unknown));
  if (!content.is_closed) warn(content, "cones: no loop, read as an open road");
  if (map.start) {
    begin_near(content, *map.start);
  } else if (!rows.options.start) {
    warn(content, fmt::format("start: not in the file, ({:.2f}, {:.2f}) taken (import --start sets it)",
                              content.points.front().position.x(), content.points.front().position.y()));
  }
  return content;
}

}  // namespace

Result<TrackFile> parse_csv_cones(std::string_view text, const std::string& file,
                                  const TrackReadOptions& options) {
  return track_of_cones(read_table(text, file, options, true));
}

Result<TrackFile> parse_yaml_cones(std::string_view text, const std::string& file,
                                   const TrackReadOptions& options) {
  const Result<YamlTree> tree = parse_yaml(text, file);
  if (!tree) return fail(tree.error());
  RoadRows rows = cone_rows(file, options);
  for (const YamlEntry& entry : tree->root->entries()) {
    const std::string& key = entry.key.text;
    const bool is_start = key == "starting_pose_front_wing";
    if (!key.starts_with("cones_") && !is_start) continue;
    std::vector<const YamlNode*> places = entry.value.children;
    if (is_start) places = {&entry.value};
    for (const YamlNode* place : places) {
      std::vector<std::string_view> cells;
      for (const YamlNode* each : place->children) cells.push_back(each->text);
      cells.resize(2);
      cells.push_back(is_start ? std::string_view("start") : std::string_view(key).substr(6));
      rows.add(place->line, cells);
    }
  }
  return track_of_cones(rows);
}

/// Whether the name or URI of a model is that of a cone.
bool is_cone(const std::string& tag) { return lower(tag).find("cone") != std::string::npos; }

/// Cones of an SDF world: an `include` or `model` whose URI or name has a colour, or a `link` of a whole
/// course whose mesh has.
Result<TrackFile> track_of_sdf(const XmlDocument& xml, const TrackReadOptions& options) {
  RoadRows rows = cone_rows(xml.file, options);
  for (const pugi::xml_node pose : xml.find_all("pose")) {
    const pugi::xml_node model = pose.parent();
    const std::string_view kind = model.name();
    const bool is_link = kind == "link" && !is_cone(model.parent().attribute("name").value());
    if (!is_link && kind != "include" && kind != "model") continue;
    std::string tag =
        (is_link ? model.child("visual").child("geometry").child("mesh") : model).child_value("uri");
    if (!is_cone(tag)) tag += model.child_value("name");
    if (tag.empty()) tag = model.attribute("name").value();
    if (!is_cone(tag)) continue;
    std::vector<std::string_view> cells = split(trim(pose.child_value()), ' ');
    cells.resize(2);
    cells.push_back(tag);
    rows.add(xml.line_of(pose), cells);
  }
  return track_of_cones(rows);
}

namespace {

// Limit of a JSON file [byte]; chosen: its tree takes far more memory.
constexpr std::size_t kMostBytes = std::size_t{16} << 20U;

/// Member of an object, or element of a list; null if there is none.
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

/// Adds a row for each element of a list: the element's members `keys`, one for each column.
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

/// Road of ROS messages of way points: {"centerline_waypoints": {"wpnts": [{"x_m": 1.0, …}, …]}, …}.
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
    double width = 0.0;  // mean
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

/// Appends the lines of a GeoJSON geometry, in which points and other shapes have none.
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
