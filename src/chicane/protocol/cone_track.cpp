// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "chicane/protocol/csv_text.hpp"
#include "chicane/protocol/detail/cones.hpp"
#include "chicane/protocol/detail/track_order.hpp"
#include "chicane/protocol/foreign_tracks.hpp"
#include "chicane/protocol/yaml_tree.hpp"

namespace chicane::protocol {
namespace {

constexpr std::size_t kMostNamed = 5;  // gaps in warnings

bool is_finite_place(double x, double y) {
  return std::fabs(x) <= road::Path::kMaxCoordinate && std::fabs(y) <= road::Path::kMaxCoordinate;
}

}  // namespace

bool ConeMap::add(std::string_view tag, const Vec2& place) {
  const std::string name = lower(tag);
  const auto has = [&](std::string_view word) { return name.find(word) != std::string::npos; };
  if (has("orange")) {
    cones.either.push_back(place);
  } else if (has("blue") || name == "left" || name == "b") {
    cones.left.push_back(place);
  } else if (has("yellow") || name == "right" || name == "y") {
    cones.right.push_back(place);
  } else if (has("car_start") || has("start")) {
    start = place;
  } else {
    return false;
  }
  return true;
}

Result<TrackFile> track_of_cones(const ConeMap& map, const std::string& file,
                                 const TrackReadOptions& options) {
  Result<survey::ConeRoad> road = survey::line_between(map.cones);
  if (!road) return fail(road.error().code, file + ": " + road.error().message);
  TrackFile content = empty_track(file, options);
  content.points = std::move(road->points);
  content.is_closed = road->is_closed;
  content.is_own_size = true;
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
  } else if (!options.start) {
    warn(content, fmt::format("start: not in the file, ({:.2f}, {:.2f}) taken (import --start sets it)",
                              content.points.front().position.x(), content.points.front().position.y()));
  }
  return content;
}

Result<TrackFile> parse_csv_cones(std::string_view text, const std::string& file,
                                  const TrackReadOptions& options) {
  ConeMap map;
  std::size_t x_at = 1, y_at = 2, tag_at = 0;
  bool is_first = true;
  CsvLines lines(text);
  for (std::optional<std::string_view> line = lines.next(); line; line = lines.next()) {
    if (line->empty() || line->front() == '#' || line->front() == '%') continue;
    const std::vector<std::string_view> values = split(*line, separator_of(*line));
    const auto fault = [&](std::string_view column, const std::string& got, std::string_view expected) {
      return fail(ErrorCode::kParse,
                  fmt::format("{}:{}: {}: got {}, expected {}", file, lines.number(), column, got, expected));
    };
    if (std::exchange(is_first, false)) {
      std::optional<std::size_t> x, y, tag;
      for (std::size_t i = 0; i < values.size(); ++i) {
        const std::string name = lower(values[i]);
        if (name == "x" || name == "x_m") x = i;
        if (name == "y" || name == "y_m") y = i;
        if (name == "tag" || name == "color" || name == "colour" || name == "type" || name == "class" ||
            name == "side")
          tag = i;
      }
      if (x && y) {
        if (!tag) return fault("header", shown(*line), "a column tag, colour or type beside x and y");
        x_at = *x;
        y_at = *y;
        tag_at = *tag;
        continue;
      }
    }
    if (values.size() <= std::max({x_at, y_at, tag_at}))
      return fault("row", fmt::format("{} columns", values.size()), "a colour, x and y");
    const std::optional<double> x = number(values[x_at]), y = number(values[y_at]);
    if (!x || !is_finite_place(*x, 0.0)) return fault("x", shown(values[x_at]), "a coordinate within 1e7 m");
    if (!y || !is_finite_place(0.0, *y)) return fault("y", shown(values[y_at]), "a coordinate within 1e7 m");
    if (!map.add(values[tag_at], {*x, *y})) ++map.unknown;
  }
  return track_of_cones(map, file, options);
}

Result<TrackFile> parse_yaml_cones(std::string_view text, const std::string& file,
                                   const TrackReadOptions& options) {
  const Result<YamlTree> tree = parse_yaml(text, file);
  if (!tree) return fail(tree.error());
  ConeMap map;
  for (const YamlEntry& entry : tree->root->entries()) {
    const std::string& key = entry.key.text;
    const bool is_start = key == "starting_pose_front_wing";
    if (!key.starts_with("cones_") && !is_start) continue;
    const std::string side = key.starts_with("cones_") ? key.substr(6) : key;
    std::vector<const YamlNode*> places = entry.value.children;
    if (is_start) places = {&entry.value};
    for (const YamlNode* place : places) {
      std::vector<double> numbers;
      for (const YamlNode* each : place->children)
        if (const std::optional<double> value = each->is_scalar() ? number(each->text) : std::nullopt)
          numbers.push_back(*value);
      if (!place->is_list() || numbers.size() < 2 || !is_finite_place(numbers[0], numbers[1]))
        return fail(ErrorCode::kParse,
                    fmt::format("{}:{}: {}: got something else, expected [x, y] within 1e7 m", file,
                                place->line, key));
      if (!map.add(is_start ? "start" : side, {numbers[0], numbers[1]})) ++map.unknown;
    }
  }
  return track_of_cones(map, file, options);
}

}  // namespace chicane::protocol
