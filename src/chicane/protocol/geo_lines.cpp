// SPDX-License-Identifier: MIT
#include "chicane/protocol/detail/geo_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "chicane/base/text.hpp"
#include "chicane/protocol/csv_text.hpp"
#include "chicane/protocol/detail/track_order.hpp"

namespace chicane::protocol {
namespace {

using survey::Geographic;
using survey::XmlNode;

constexpr double kLeastStep = 1.0;    // nearer places are where a receiver stands still [m]
constexpr double kLeastLap = 150.0;   // [m]
constexpr double kMeets = 25.0;       // a lap is over where it comes this near to its beginning [m]
constexpr double kMostExtent = 50e3;  // [m]

std::string at(const std::string& file, const XmlNode& node) { return fmt::format("{}:{}", file, node.line); }

bool is_place(const Geographic& place) {
  return std::fabs(place.latitude) < 85.0 && std::fabs(place.longitude) <= 360.0;
}

Error bad_place(const std::string& file, const XmlNode& node, std::string_view got) {
  return {ErrorCode::kParse,
          fmt::format("{}: {}: got {}, expected latitude and longitude in degrees, below 85", at(file, node),
                      printable(node.name), got)};
}

/// All elements of a name, in the order of the document.
void find_all(const XmlNode& node, std::string_view name, std::vector<const XmlNode*>& found) {
  if (node.name == name) found.push_back(&node);
  for (const XmlNode* child : node.children) find_all(*child, name, found);
}

/// Points up to where the line meets its beginning in the same direction; how many laps the line has.
double cut_first_lap(std::vector<Vec2>& points) {
  double passed = 0.0, total = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) total += (points[i] - points[i - 1]).norm();
  const Vec2 ahead = points[std::min<std::size_t>(3, points.size() - 1)] - points[0];
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    passed += (points[i] - points[i - 1]).norm();
    const double away = (points[i] - points[0]).norm();
    const bool is_nearest =
        away <= (points[i + 1] - points[0]).norm() && away <= (points[i - 1] - points[0]).norm();
    if (passed < kLeastLap || away > kMeets || !is_nearest || (points[i + 1] - points[i]).dot(ahead) <= 0.0)
      continue;
    points.resize(i);
    return total / passed;
  }
  return 1.0;
}

}  // namespace

Result<TrackFile> track_of_line(const GeoLine& line, const std::string& file,
                                const TrackReadOptions& options) {
  if (line.places.size() < 4)
    return fail(ErrorCode::kParse,
                fmt::format("{}: line: got {} places, expected at least 4", file, line.places.size()));
  if (line.places.size() > kMaxTrackPoints)
    return fail(ErrorCode::kParse,
                fmt::format("{}: line: got {} places, expected at most 1000000", file, line.places.size()));
  std::vector<Vec2> points;
  double most = 0.0;
  for (const Vec2& each : survey::to_plane(line.places)) {
    most = std::max(most, each.norm());
    if (points.empty() || (each - points.back()).norm() >= kLeastStep) points.push_back(each);
  }
  if (most > kMostExtent)
    return fail(
        ErrorCode::kParse,
        fmt::format("{}: line: got one that is {:.0f} km wide, expected at most 100 km", file, 2e-3 * most));
  TrackFile content = empty_track(file, options);
  const double laps = line.is_driven && points.size() > 8 ? cut_first_lap(points) : 1.0;
  for (const Vec2& point : points) content.points.push_back({point, 0.0, 0.0});
  if (content.points.empty()) return fail(ErrorCode::kParse, file + ": line: got one place, expected a line");
  settle_ends(content, options.is_closed, line.is_driven ? kMeets : 0.0);
  const Geographic middle = survey::middle_of(line.places);
  warn(content, fmt::format("places: metres east and north of {:.6f}, {:.6f}; heights left out",
                            middle.latitude, middle.longitude));
  if (laps > 1.2) warn(content, fmt::format("laps: the first of {:.1f} taken", laps));
  content.options.smoothing_sigma = line.noise * options.scale;
  if (!options.smoothing_sigma)
    warn(content, fmt::format("smoothing: noise of {} m assumed (import --smoothing-m sets it)",
                              content.options.smoothing_sigma));
  if (line.width > 0.0 && line.width <= kMaxTrackWidth) {
    for (road::TrackPoint& point : content.points) point.left = point.right = 0.5 * line.width;
  } else {
    assume_width(content, options);
  }
  return content;
}

Result<TrackFile> track_of_gpx(const XmlNode& root, const std::string& file,
                               const TrackReadOptions& options) {
  GeoLine line{.noise = 1.0, .is_driven = true};
  std::vector<const XmlNode*> found;
  for (const char* name : {"trkpt", "rtept", "wpt"}) {
    if (found.empty()) find_all(root, name, found);
  }
  for (const XmlNode* node : found) {
    const std::optional<double> latitude = node->number("lat"), longitude = node->number("lon");
    const Geographic place{latitude.value_or(1e9), longitude.value_or(1e9)};
    if (!is_place(place)) return fail(bad_place(file, *node, printable(node->attribute("lat"))));
    line.places.push_back(place);
  }
  return track_of_line(line, file, options);
}

Result<TrackFile> track_of_kml(const XmlNode& root, const std::string& file,
                               const TrackReadOptions& options) {
  std::vector<const XmlNode*> lines, driven;
  find_all(root, "coordinates", lines);
  find_all(root, "coord", driven);
  GeoLine best;
  // "lon,lat,height lon,lat,height": the element with most places is the road, others are marks.
  for (const XmlNode* node : lines) {
    GeoLine line;
    for (const std::string_view place : split(node->text, '\n'))
      for (const std::string_view each : split(place, ' ')) {
        const std::vector<std::string_view> values = split(each, ',');
        const std::optional<double> longitude = number(values[0]);
        const std::optional<double> latitude = values.size() > 1 ? number(values[1]) : std::nullopt;
        const Geographic found{latitude.value_or(1e9), longitude.value_or(1e9)};
        if (!is_place(found)) return fail(bad_place(file, *node, shown(each)));
        line.places.push_back(found);
      }
    if (line.places.size() > best.places.size()) best = std::move(line);
  }
  if (driven.size() > best.places.size()) {
    best = {.noise = 1.0, .is_driven = true};
    for (const XmlNode* node : driven) {
      const std::vector<std::string_view> values = split(trim(node->text), ' ');
      const std::optional<double> longitude = values.empty() ? std::nullopt : number(values[0]);
      const std::optional<double> latitude = values.size() > 1 ? number(values[1]) : std::nullopt;
      const Geographic found{latitude.value_or(1e9), longitude.value_or(1e9)};
      if (!is_place(found)) return fail(bad_place(file, *node, shown(node->text)));
      best.places.push_back(found);
    }
  }
  return track_of_line(best, file, options);
}

namespace {

struct OsmWay {
  std::deque<std::string> nodes;
  double width = 0.0;  ///< [m]; 0: none in the file
  bool is_raceway = false, is_one_way = false;
};

OsmWay way_of(const XmlNode& node) {
  OsmWay way;
  for (const XmlNode* child : node.children) {
    if (child->name == "nd") way.nodes.emplace_back(child->attribute("ref"));
    if (child->name != "tag") continue;
    const std::string_view key = child->attribute("k"), value = child->attribute("v");
    if (key == "width") way.width = survey::number_in(value.substr(0, value.find(' '))).value_or(0.0);
    if (key == "highway" && value == "raceway") way.is_raceway = true;
    if (key == "oneway" && value == "yes") way.is_one_way = true;
  }
  return way;
}

bool is_closed(const OsmWay& way) { return way.nodes.size() > 3 && way.nodes.front() == way.nodes.back(); }

/// Joins `way` with others at its ends until it is closed or none fits.
void join(OsmWay& way, std::vector<OsmWay>& others) {
  for (bool has_grown = true; has_grown && !is_closed(way);) {
    has_grown = false;
    for (std::size_t i = 0; i < others.size() && !has_grown; ++i) {
      OsmWay& other = others[i];
      if (other.nodes.size() < 2) continue;
      const bool is_behind = other.nodes.front() == way.nodes.back();
      if (!is_behind && other.nodes.back() == way.nodes.back() && !other.is_one_way)
        std::reverse(other.nodes.begin(), other.nodes.end());
      if (other.nodes.front() == way.nodes.back()) {
        way.nodes.insert(way.nodes.end(), other.nodes.begin() + 1, other.nodes.end());
        has_grown = true;
      } else if (other.nodes.back() == way.nodes.front()) {
        way.nodes.insert(way.nodes.begin(), other.nodes.begin(), other.nodes.end() - 1);
        has_grown = true;
      }
      if (has_grown && way.width == 0.0) way.width = other.width;
      if (has_grown) others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
}

}  // namespace

Result<TrackFile> track_of_osm(const XmlNode& root, const std::string& file,
                               const TrackReadOptions& options) {
  constexpr std::size_t kMostWays = 2000;
  std::map<std::string, Geographic, std::less<>> nodes;
  std::vector<OsmWay> ways;
  for (const XmlNode* child : root.children) {
    if (child->name == "node") {
      const Geographic place{child->number("lat").value_or(1e9), child->number("lon").value_or(1e9)};
      if (child->attribute("action") == "delete") continue;
      if (!is_place(place)) return fail(bad_place(file, *child, printable(child->attribute("lat"))));
      nodes[std::string(child->attribute("id"))] = place;
    } else if (child->name == "way") {
      if (OsmWay way = way_of(*child); way.nodes.size() > 1) ways.push_back(std::move(way));
      if (ways.size() > kMostWays)
        return fail(ErrorCode::kParse,
                    fmt::format("{}: way: got more than {}, expected an extract of one course",
                                at(file, *child), kMostWays));
    }
  }
  const std::size_t count = ways.size();
  const bool has_raceway =
      std::any_of(ways.begin(), ways.end(), [](const OsmWay& way) { return way.is_raceway; });
  if (has_raceway) std::erase_if(ways, [](const OsmWay& way) { return !way.is_raceway; });
  if (ways.empty()) return fail(ErrorCode::kParse, file + ": way: got none, expected at least one");
  // The closed course of most nodes, else the longest.
  OsmWay best;
  std::size_t joined = 0;
  while (!ways.empty()) {
    const std::size_t before = ways.size();
    OsmWay way = std::move(ways.back());
    ways.pop_back();
    join(way, ways);
    const bool is_better =
        is_closed(way) != is_closed(best) ? is_closed(way) : way.nodes.size() > best.nodes.size();
    if (is_better) {
      best = std::move(way);
      joined = before - ways.size();
    }
  }
  GeoLine line{.width = best.width};
  for (const std::string& id : best.nodes) {
    const auto node = nodes.find(id);
    if (node == nodes.end())
      return fail(ErrorCode::kParse,
                  fmt::format("{}: way: got a node {} that is not in the file, expected all nodes of the way",
                              file, printable(id)));
    line.places.push_back(node->second);
  }
  Result<TrackFile> content = track_of_line(line, file, options);
  if (content && joined < count)
    warn(*content, fmt::format("way: {} of {} ways taken, {}", joined, count,
                               has_raceway ? "those of highway=raceway that hang together"
                                           : "those that hang together"));
  return content;
}

}  // namespace chicane::protocol
