// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "chicane/protocol/csv_text.hpp"
#include "chicane/protocol/detail/foreign_roads.hpp"
#include "chicane/protocol/foreign_tracks.hpp"
#include "chicane/protocol/yaml_tree.hpp"
#include "chicane/survey/cone_line.hpp"

namespace chicane::protocol {
namespace {

constexpr std::size_t kMostNamed = 5;  // gaps in warnings

RoadRows cone_rows(const std::string& file, const TrackReadOptions& options) {
  return {file, options, {{"x", Column::kX}, {"y", Column::kY}, {"tag", Column::kTag}}};
}

/// Cones by what files call them: "blue", "cone_yellow", "big_orange", "left".
struct ConeMap {
  survey::Cones cones;
  std::optional<Vec2> start{};
  int unknown = 0;  ///< cones whose colour names no side

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

/// The road between cones; gaps are named.
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

bool is_cone(const std::string& tag) { return lower(tag).find("cone") != std::string::npos; }

/// Each cone is an `include` or a `model` whose URI or name has its colour, or a `link` of a whole course
/// whose mesh has.
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

}  // namespace chicane::protocol
