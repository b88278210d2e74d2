// SPDX-License-Identifier: MIT
// Roads from lines in geographic coordinates: GPX, KML and OpenStreetMap. Each reader collects one line of
// latitudes and longitudes; track_of_line() projects it to metres, takes one lap, and estimates its noise.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <utility>

#include "chicane/base/text.hpp"
#include "chicane/protocol/csv_text.hpp"
#include "chicane/protocol/detail/foreign_roads.hpp"
#include "chicane/road/smooth_line.hpp"
#include "chicane/survey/sampled_line.hpp"

namespace chicane::protocol {
namespace {

using survey::Geographic;

constexpr double kLeastStep =
    1.0;  // [m] between points: nearer ones are of a receiver that stands still; chosen
constexpr double kLeastLap = 150.0;  // [m] length of the shortest lap; chosen
constexpr double kMeets = 25.0;  // [m] from its beginning to the end of a lap, at most; chosen: errors of GPS
constexpr double kMostExtent = 50e3;  // [m] from the middle; chosen: beyond it the projection bends roads
constexpr double kLeastNoise = 0.05;  // [m] derived: half a unit of the sixth decimal of a degree

/// Cuts off the points from where the line meets its beginning in the same direction. Returns the number of
/// laps that the line had.
double cut_first_lap(std::vector<Vec2>& points) {
  double passed = 0.0;
  const double total = survey::length_of(points, false);
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

/// Adds the point of a node with latitude and longitude.
void add_node(const XmlDocument& xml, pugi::xml_node node, GeoLine& line) {
  line.rows.add(xml.line_of(node),
                {trim(node.attribute("lat").value()), trim(node.attribute("lon").value())});
}

}  // namespace

Result<TrackFile> track_of_line(GeoLine line) {
  RoadRows& rows = line.rows;
  TrackFile& content = rows.content;
  rows.list.clear();
  rows.expect_points(4);
  if (rows.error) return fail(*rows.error);
  std::vector<Geographic> places;
  for (const road::TrackPoint& point : content.points)
    places.push_back({point.position.y(), point.position.x()});
  std::vector<Vec2> points;
  double most = 0.0;
  for (const Vec2& each : survey::to_plane(places)) {
    most = std::max(most, each.norm());
    if (points.empty() || (each - points.back()).norm() >= kLeastStep) points.push_back(each);
  }
  if (most > kMostExtent)
    rows.fault(0, "line", fmt::format("one that is {:.0f} km wide", 2e-3 * most), "at most 100 km");
  const double laps = line.is_driven && points.size() > 8 ? cut_first_lap(points) : 1.0;
  // One width for the whole line.
  const bool has_width = line.width > 0.0 && line.width <= kMaxTrackWidth;
  road::TrackPoint point = content.points.front();
  if (has_width) point.left = point.right = 0.5 * line.width;
  content.points.clear();
  content.lines.clear();
  for (const Vec2& each : points) content.points.push_back({each, point.left, point.right});
  rows.meets = line.is_driven ? kMeets : 0.0;
  Result<TrackFile> built = rows.build();
  if (!built) return built;
  const Geographic middle = survey::middle_of(places);
  warn(*built, fmt::format("places: metres east and north of {:.6f}, {:.6f}; heights left out",
                           middle.latitude, middle.longitude));
  if (laps > 1.2) warn(*built, fmt::format("laps: the first of {:.1f} taken", laps));
  if (!rows.options.smoothing_sigma) {
    double& noise = built->options.smoothing_sigma;
    noise = std::clamp(road::estimate_noise(points, built->is_closed, built->options.spacing), kLeastNoise,
                       line.most_noise);
    warn(*built, fmt::format("smoothing: noise of {:.2f} m estimated from the points (import --smoothing-m "
                             "sets it)",
                             noise));
  }
  if (!has_width) warn_of_width(*built, rows.options);
  return built;
}

Result<TrackFile> track_of_gpx(const XmlDocument& xml, const TrackReadOptions& options) {
  GeoLine line{xml.file, options, true};
  std::vector<pugi::xml_node> found;
  for (const char* name : {"trkpt", "rtept", "wpt"})
    if (found.empty()) found = xml.find_all(name);
  for (const pugi::xml_node node : found) add_node(xml, node, line);
  return track_of_line(std::move(line));
}

Result<TrackFile> track_of_kml(const XmlDocument& xml, const TrackReadOptions& options) {
  const auto add = [&](GeoLine& line, pugi::xml_node node, std::string_view place, char separator) {
    std::vector<std::string_view> cells = split(trim(place), separator);
    cells.resize(2);  // "lon,lat,height"
    line.rows.add(xml.line_of(node), {cells[1], cells[0]});
  };
  const auto is_longer = [](const GeoLine& a, const GeoLine& b) {
    return !b.rows.error && (a.rows.error || a.rows.content.points.size() > b.rows.content.points.size());
  };
  // Takes the element with most points as the road: others are marks.
  GeoLine best{xml.file, options};
  for (const pugi::xml_node node : xml.find_all("coordinates")) {
    GeoLine line{xml.file, options};
    for (const pugi::xml_node part : node.children())
      for (const std::string_view row : split(part.value(), '\n'))
        for (const std::string_view place : split(row, ' ')) add(line, node, place, ',');
    if (is_longer(line, best)) best = std::move(line);
  }
  GeoLine log{xml.file, options, true};
  for (const pugi::xml_node node : xml.find_all("coord")) add(log, node, node.child_value(), ' ');
  return track_of_line(is_longer(log, best) ? std::move(log) : std::move(best));
}

namespace {

/// Way of OpenStreetMap.
struct OsmWay {
  std::deque<std::string> nodes;  ///< ids
  double width = 0.0;             ///< [m]; 0: none in the file
  bool is_raceway = false, is_one_way = false;
};

OsmWay way_of(pugi::xml_node node) {
  OsmWay way;
  for (const pugi::xml_node child : node.children("nd"))
    way.nodes.emplace_back(child.attribute("ref").value());
  for (const pugi::xml_node child : node.children("tag")) {
    const std::string_view key = child.attribute("k").value(), value = child.attribute("v").value();
    if (key == "width") way.width = number(trim(value.substr(0, value.find(' ')))).value_or(0.0);
    if (key == "highway" && value == "raceway") way.is_raceway = true;
    if (key == "oneway" && value == "yes") way.is_one_way = true;
  }
  return way;
}

bool is_closed(const OsmWay& way) { return way.nodes.size() > 3 && way.nodes.front() == way.nodes.back(); }

/// Joins `way` with others that share its first or last node, until it is closed or none is left. Joined ways
/// leave `others`.
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

Result<TrackFile> track_of_osm(const XmlDocument& xml, const TrackReadOptions& options) {
  constexpr std::size_t kMostWays = 2000;
  for (const pugi::xml_node relation : xml.root().children("relation"))
    if (relation.find_child_by_attribute("tag", "v", "lanelet"))
      return fail(fault_of(xml.file, xml.line_of(relation), "relation", "a lanelet of a Lanelet2 map",
                           "ways of a course, since maps of lanelets are not read"));
  std::map<std::string, pugi::xml_node, std::less<>> nodes;
  for (const pugi::xml_node node : xml.root().children("node"))
    if (node.attribute("action").value() != std::string_view("delete"))
      nodes[node.attribute("id").value()] = node;
  std::vector<OsmWay> ways;
  for (const pugi::xml_node node : xml.root().children("way")) {
    if (OsmWay way = way_of(node); way.nodes.size() > 1) ways.push_back(std::move(way));
    if (ways.size() > kMostWays)
      return fail(fault_of(xml.file, xml.line_of(node), "way", fmt::format("more than {}", kMostWays),
                           "an extract of one course"));
  }
  const std::size_t count = ways.size();
  const bool has_raceway =
      std::any_of(ways.begin(), ways.end(), [](const OsmWay& way) { return way.is_raceway; });
  if (has_raceway) std::erase_if(ways, [](const OsmWay& way) { return !way.is_raceway; });
  if (ways.empty()) return fail(fault_of(xml.file, 0, "way", "none", "at least one"));
  // Takes the closed course of most nodes; without a closed one the course of most nodes.
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
  GeoLine line{xml.file, options};
  line.width = best.width;
  for (const std::string& id : best.nodes) {
    const auto node = nodes.find(id);
    if (node == nodes.end())
      return fail(fault_of(xml.file, 0, "way",
                           fmt::format("a node {} that is not in the file", printable(id)),
                           "all nodes of the way"));
    add_node(xml, node->second, line);
  }
  Result<TrackFile> content = track_of_line(std::move(line));
  if (content && joined < count)
    warn(*content, fmt::format("way: {} of {} ways taken, {}", joined, count,
                               has_raceway ? "those of highway=raceway that hang together"
                                           : "those that hang together"));
  return content;
}

}  // namespace chicane::protocol
