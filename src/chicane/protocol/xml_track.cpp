// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "chicane/base/text.hpp"
#include "chicane/protocol/csv_text.hpp"
#include "chicane/protocol/detail/cones.hpp"
#include "chicane/protocol/detail/geo_lines.hpp"
#include "chicane/protocol/foreign_tracks.hpp"
#include "chicane/survey/xml_tree.hpp"

namespace chicane::protocol {
namespace {

using survey::XmlNode;

/// Cones of a world of Gazebo: each is an `include` or a `model` whose URI or name has its colour.
void find_cones(const XmlNode& node, ConeMap& map) {
  for (const XmlNode* child : node.children) {
    if (child->name != "include" && child->name != "model") {
      find_cones(*child, map);
      continue;
    }
    const XmlNode* const pose = child->child("pose");
    const XmlNode* const uri = child->child("uri");
    const XmlNode* const name = child->child("name");
    std::string tag = uri != nullptr ? uri->text : "";
    if (name != nullptr && lower(tag).find("cone") == std::string::npos) tag += name->text;
    if (tag.empty()) tag = child->attribute("name");
    if (lower(tag).find("cone") == std::string::npos || pose == nullptr) {
      find_cones(*child, map);
      continue;
    }
    const std::vector<std::string_view> values = split(trim(pose->text), ' ');
    const std::optional<double> x = values.empty() ? std::nullopt : number(values[0]);
    const std::optional<double> y = values.size() > 1 ? number(values[1]) : std::nullopt;
    const bool is_place = x && y && std::max(std::fabs(*x), std::fabs(*y)) <= road::Path::kMaxCoordinate;
    if (!is_place || !map.add(tag, {*x, *y})) ++map.unknown;
  }
}

Result<TrackFile> track_of_sdf(const XmlNode& root, const std::string& file,
                               const TrackReadOptions& options) {
  ConeMap map;
  find_cones(root, map);
  return track_of_cones(map, file, options);
}

struct Dialect {
  std::string_view root;
  Result<TrackFile> (*read)(const XmlNode&, const std::string&, const TrackReadOptions&);
};
constexpr std::array kDialects{
    Dialect{"gpx", &track_of_gpx},
    Dialect{"kml", &track_of_kml},
    Dialect{"osm", &track_of_osm},
    Dialect{"OpenDRIVE", &track_of_opendrive},
    Dialect{"commonRoad", &track_of_commonroad},
    Dialect{"sdf", &track_of_sdf},
};

}  // namespace

Result<TrackFile> parse_xml_track(std::string_view text, const std::string& file,
                                  const TrackReadOptions& options) {
  const Result<survey::XmlTree> tree = survey::parse_xml(text, file);
  if (!tree) return fail(tree.error());
  const XmlNode& root = tree->root();
  for (const Dialect& dialect : kDialects)
    if (root.name == dialect.root) return dialect.read(root, file, options);
  return fail(ErrorCode::kParse,
              fmt::format("{}:{}: got the element {}, expected gpx, kml, osm, OpenDRIVE, commonRoad or sdf",
                          file, root.line, printable(root.name)));
}

}  // namespace chicane::protocol
