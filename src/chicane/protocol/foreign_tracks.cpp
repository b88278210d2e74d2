// SPDX-License-Identifier: MIT
#include "chicane/protocol/foreign_tracks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "chicane/base/text.hpp"
#include "chicane/protocol/csv_text.hpp"
#include "chicane/protocol/detail/foreign_roads.hpp"

namespace chicane::protocol {
namespace {

constexpr std::size_t kHead = 4096;  // bytes that are looked at

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

/// An object: GeoJSON, or the way points of the ForzaETH race stack.
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

/// A table whose first row of numbers names a colour.
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

}  // namespace chicane::protocol
