// SPDX-License-Identifier: MIT
// XML documents, and roads of OpenDRIVE in them: the course along the lanes of connected roads.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/csv_text.hpp"
#include "chicane/protocol/detail/foreign_roads.hpp"
#include "chicane/protocol/detail/road_rows.hpp"

namespace chicane::protocol {
namespace {

/// Visitor of all elements in the order of the document.
template <typename Visit>
struct Walker : pugi::xml_tree_walker {
  explicit Walker(Visit each) : visit{each} {}
  bool for_each(pugi::xml_node& node) override {
    return node.type() != pugi::node_element || visit(node, depth());
  }
  Visit visit;
};

/// Line of a position in the text, from 1.
int line_at(const XmlDocument& xml, std::ptrdiff_t offset) {
  const auto end = std::lower_bound(xml.line_ends.begin(), xml.line_ends.end(), offset);
  return static_cast<int>(end - xml.line_ends.begin()) + 1;
}

}  // namespace

int XmlDocument::line_of(pugi::xml_node node) const { return line_at(*this, node.offset_debug()); }

std::vector<pugi::xml_node> XmlDocument::find_all(std::string_view name) const {
  std::vector<pugi::xml_node> found;
  Walker walker([&](pugi::xml_node node, int) {
    if (node.name() == name) found.push_back(node);
    return true;
  });
  pugi::xml_node(tree).traverse(walker);
  return found;
}

Result<XmlDocument> parse_xml(std::string_view text, const std::string& file) {
  XmlDocument xml{.file = file};
  const auto refuse = [&](std::ptrdiff_t at, std::string_view why) {
    return fail(fault_of(file, line_at(xml, at), "file", fmt::format("XML that cannot be read: {}", why),
                         "a document of one course"));
  };
  if (text.size() > XmlDocument::kMostBytes) return refuse(0, "more than 32 MiB");
  if (std::count(text.begin(), text.end(), '<') > XmlDocument::kMostTags)
    return refuse(0, "more than 2000000 tags");
  for (std::size_t i = text.find('\n'); i != std::string_view::npos; i = text.find('\n', i + 1))
    xml.line_ends.push_back(static_cast<std::ptrdiff_t>(i));
  if (const std::size_t at = text.find("<!ENTITY"); at != std::string_view::npos)
    return refuse(static_cast<std::ptrdiff_t>(at), "entities of its own, which are not read");
  const pugi::xml_parse_result parsed = xml.tree.load_buffer(text.data(), text.size());
  if (!parsed) return refuse(parsed.offset, parsed.description());
  if (const pugi::xml_node next = xml.root().next_sibling())
    return refuse(next.offset_debug(), "a second root element");
  Walker walker([](pugi::xml_node node, int depth) {
    const std::string name = node.name();
    if (const std::size_t colon = name.rfind(':'); colon != std::string::npos)
      node.set_name(name.substr(colon + 1).c_str());
    return depth < XmlDocument::kMostDepth;
  });
  if (!xml.tree.traverse(walker)) return refuse(0, "elements nested more than 64 deep");
  return xml;
}

double number_at(pugi::xml_node node, const char* attribute, double otherwise) {
  return number(trim(node.attribute(attribute).value())).value_or(otherwise);
}

namespace {

using pugi::xml_node;

// Chosen: a course of cars has these sizes, and files round their numbers.
constexpr double kMostLength = 100e3;  // [m] of a course
constexpr double kLeastWidth = 0.5;    // [m] of a cross-section
constexpr double kStep = 0.5;          // [m] along a reference line
constexpr double kSpacing = 2.0;       // [m] of the road's points
constexpr double kReach = 4.0;         // [m] of the moving average, to each side
constexpr double kMostJump = 0.1;      // [m] between pieces of a reference line
constexpr double kMostKink = 0.05;     // [rad] between pieces of a reference line

// OpenDRIVE has a reference line of lines, arcs, spirals and polynomials, with lanes on both sides.

/// Polynomial a + b u + c u² + d u³ of u = s − from.
struct Cubic {
  double from = 0.0;                ///< begin [m]
  std::array<double, 4> factors{};  ///< a to d
  [[nodiscard]] double at(double s) const {
    const double u = s - from;
    return factors[0] + u * (factors[1] + u * (factors[2] + u * factors[3]));
  }
  [[nodiscard]] double slope_at(double s) const {
    const double u = s - from;
    return factors[1] + u * (2.0 * factors[2] + u * 3.0 * factors[3]);
  }
};

/// Polynomial of an element, with these names of its factors.
Cubic cubic_of(xml_node node, double from, std::array<const char*, 4> names = {"a", "b", "c", "d"}) {
  Cubic cubic{from, {}};
  for (std::size_t i = 0; i < names.size(); ++i) cubic.factors[i] = number_at(node, names[i]);
  return cubic;
}

/// Last piece that begins at or before s; the first piece for an s before all; null if there is none.
template <typename Piece>
const Piece* last_at(const std::vector<Piece>& pieces, double s) {
  const Piece* found = nullptr;
  for (const Piece& piece : pieces)
    if (piece.from <= s + 1e-9 || found == nullptr) found = &piece;
  return found;
}
/// Value of a piecewise polynomial at s; 0 without pieces.
double value_at(const std::vector<Cubic>& pieces, double s) {
  const Cubic* const piece = last_at(pieces, s);
  return piece != nullptr ? piece->at(s) : 0.0;
}

/// Lane of a section.
struct Lane {
  int id = 0;  ///< from the reference line outwards: 1, 2, … to the left, −1, −2, … to the right
  bool is_driven = false;  ///< a lane to drive on
  std::vector<Cubic> width;
};
/// Cross-section of lanes from one arc length on.
struct LaneSection {
  double from = 0.0;        ///< [m]
  std::vector<Lane> lanes;  ///< the inner ones first, left ones before right ones
};

/// Piece of a reference line: position and heading along one geometry element.
class Geometry {
 public:
  explicit Geometry(xml_node node)
      : place_{number_at(node, "x", NAN), number_at(node, "y", NAN)},
        heading_{number_at(node, "hdg", NAN)},
        length_{number_at(node, "length", NAN)} {
    if (const xml_node arc = node.child("arc")) {
      begin_ = end_ = number_at(arc, "curvature", NAN);
    } else if (const xml_node spiral = node.child("spiral")) {
      begin_ = number_at(spiral, "curvStart", NAN);
      end_ = number_at(spiral, "curvEnd", NAN);
    } else if (const xml_node poly = node.child("paramPoly3")) {
      across_ = cubic_of(poly, 0.0, {"aV", "bV", "cV", "dV"});
      along_ = cubic_of(poly, 0.0, {"aU", "bU", "cU", "dU"});
      is_normalised_ = poly.attribute("pRange").value() != std::string_view("arcLength");
    } else if (const xml_node poly3 = node.child("poly3")) {
      across_ = cubic_of(poly3, 0.0);
    }
  }
  /// Whether all numbers are there and in range.
  [[nodiscard]] bool is_sound() const {
    return place_.is_finite() && std::fabs(place_.x()) < 1e7 && std::fabs(place_.y()) < 1e7 &&
           std::isfinite(heading_) && length_ >= 0.0 && length_ < kMostLength && std::fabs(begin_) < 10.0 &&
           std::fabs(end_) < 10.0;
  }
  [[nodiscard]] double length() const { return length_; }

  /// Position and heading at `count` + 1 evenly spaced arc lengths.
  [[nodiscard]] std::vector<std::pair<Vec2, double>> sampled(int count) const {
    std::vector<std::pair<Vec2, double>> samples;
    Vec2 at = place_;
    const double step = length_ / count;
    for (int i = 0; i <= count; ++i) {
      const double s = step * i;
      if (across_) {
        samples.push_back(polynomial_at(s));
        continue;
      }
      samples.emplace_back(at, heading_at(s));
      constexpr int kParts = 4;  // parts of a step: Simpson's rule
      for (int part = 0; part < kParts; ++part) {
        const double h = step / kParts, u = s + part * h;
        const double a = heading_at(u), b = heading_at(u + 0.5 * h), c = heading_at(u + h);
        at += h / 6.0 * Vec2{cos(a) + 4.0 * cos(b) + cos(c), sin(a) + 4.0 * sin(b) + sin(c)};
      }
    }
    return samples;
  }

 private:
  [[nodiscard]] double heading_at(double s) const {
    return heading_ + begin_ * s + (length_ > 0.0 ? 0.5 * (end_ - begin_) / length_ * s * s : 0.0);
  }
  [[nodiscard]] std::pair<Vec2, double> polynomial_at(double s) const {
    const double p = is_normalised_ && length_ > 0.0 ? s / length_ : s;
    const double c = cos(heading_), si = sin(heading_);
    const double u = along_ ? along_->at(p) : p, v = across_->at(p);
    const double du = along_ ? along_->slope_at(p) : 1.0;
    return {place_ + Vec2{c * u - si * v, si * u + c * v}, heading_ + atan2(across_->slope_at(p), du)};
  }

  Vec2 place_{};                         ///< beginning [m]
  double heading_ = 0.0, length_ = 0.0;  ///< heading at the beginning [rad], length [m]
  double begin_ = 0.0, end_ = 0.0;       ///< curvature at both ends [1/m]; linear between
  std::optional<Cubic> across_,
      along_;                   ///< polynomials v and u in the frame of the beginning; without along_ u = s
  bool is_normalised_ = false;  ///< their argument goes from 0 to 1, not to length_
};

std::vector<LaneSection> sections_of(xml_node lanes) {
  std::vector<LaneSection> sections;
  for (const xml_node node : lanes.children("laneSection")) {
    LaneSection section{number_at(node, "s"), {}};
    for (const char* side : {"left", "right"})
      for (const xml_node each : node.child(side).children("lane")) {
        const std::string_view type = each.attribute("type").value();
        Lane lane{static_cast<int>(std::clamp(number_at(each, "id"), -1000.0, 1000.0)),
                  type == "driving" || type == "bidirectional",
                  {}};
        for (const xml_node width : each.children("width"))
          lane.width.push_back(cubic_of(width, section.from + number_at(width, "sOffset")));
        section.lanes.push_back(std::move(lane));
      }
    std::sort(section.lanes.begin(), section.lanes.end(),
              [](const Lane& a, const Lane& b) { return std::abs(a.id) < std::abs(b.id); });
    sections.push_back(std::move(section));
  }
  return sections;
}

/// Offsets of both edges of the driven lanes from the reference line, the right edge first, left positive
/// [m]; none without a driven lane of a plausible width.
std::optional<std::pair<double, double>> driven_at(const std::vector<LaneSection>& sections,
                                                   const std::vector<Cubic>& offsets, double s) {
  const LaneSection* const section = last_at(sections, s);
  if (section == nullptr) return std::nullopt;
  const double offset = value_at(offsets, s);
  double left = offset, right = offset;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Lane& lane : section->lanes) {
    const double width = std::max(0.0, value_at(lane.width, s));
    double& edge = lane.id > 0 ? left : right;
    const double outer = edge + (lane.id > 0 ? width : -width);
    if (lane.is_driven) {
      low = std::min({low, edge, outer});
      high = std::max({high, edge, outer});
    }
    edge = outer;
  }
  return high - low >= kLeastWidth && high - low <= kMaxTrackWidth ? std::optional(std::pair(low, high))
                                                                   : std::nullopt;
}

/// Adds a fault if a piece does not begin with the position and heading of the end before.
void check_joint(const std::pair<Vec2, double>& end, const std::pair<Vec2, double>& begin, double s,
                 const std::string& road, int line, RoadRows& rows) {
  const double jump = (begin.first - end.first).norm();
  const double kink = std::fabs(angle_difference(begin.second, end.second));
  if (jump <= kMostJump && kink <= kMostKink) return;
  rows.fault(line, "geometry",
             jump > kMostJump ? fmt::format("a jump of {:.2f} m at s = {:.1f} m of road {}", jump, s, road)
                              : fmt::format("a kink of {:.2f} rad at s = {:.1f} m of road {}", kink, s, road),
             fmt::format("pieces that join within {} m and {} rad", kMostJump, kMostKink));
}

/// Adds points in the middle of a road's driven lanes, in its direction or against it.
void lay_out(const XmlDocument& xml, xml_node road, bool is_forward, RoadRows& rows) {
  const xml_node plan = road.child("planView"), lanes = road.child("lanes");
  if (!plan || !lanes) return rows.fault(xml.line_of(road), "road", "no planView and lanes", "both");
  std::vector<Cubic> offsets;
  for (const xml_node node : lanes.children("laneOffset"))
    offsets.push_back(cubic_of(node, number_at(node, "s")));
  const std::vector<LaneSection> sections = sections_of(lanes);
  std::vector<road::TrackPoint> points;
  double passed = 0.0;
  std::optional<std::pair<Vec2, double>> end;
  for (const xml_node node : plan.children("geometry")) {
    const Geometry geometry(node);
    if (!geometry.is_sound())
      return rows.fault(xml.line_of(node), "geometry", "numbers out of range",
                        "x, y, hdg, length and curvature of a road");
    if (geometry.length() < 1e-6) continue;
    if (passed > kMostLength)
      return rows.fault(xml.line_of(node), "geometry", "more than 100 km", "a course");
    const int count = std::max(1, static_cast<int>(std::ceil(geometry.length() / kStep)));
    const std::vector<std::pair<Vec2, double>> samples = geometry.sampled(count);
    if (end)
      check_joint(*end, samples.front(), passed, road.attribute("id").value(), xml.line_of(node), rows);
    if (rows.error) return;
    for (int i = end ? 1 : 0; i <= count; ++i) {
      const auto& [place, heading] = samples[static_cast<std::size_t>(i)];
      const double s = passed + geometry.length() * i / count;
      const auto driven = driven_at(sections, offsets, s);
      if (!driven)
        return rows.fault(xml.line_of(node), "lane", "none to drive on, or too narrow",
                          "lanes of type driving, 0.5 to 1000 m in all");
      const auto [low, high] = *driven;
      const double middle = 0.5 * (low + high);
      points.push_back(
          {place + middle * Vec2{-sin(heading), cos(heading)}, 0.5 * (high - low), 0.5 * (high - low)});
    }
    passed += geometry.length();
    end = samples.back();
  }
  if (const double stated = number_at(road, "length", passed); std::fabs(stated - passed) > 0.01 * passed)
    warn(rows.content,
         fmt::format("length: road {} states {:.1f} m, and its planView of {:.1f} m is taken",
                     printable(road.attribute("id").value()), stated, passed),
         xml.line_of(road));
  if (!is_forward) std::reverse(points.begin(), points.end());
  for (const road::TrackPoint& point : points) {
    const std::vector<road::TrackPoint>& known = rows.content.points;
    if (known.empty() || (known.back().position - point.position).norm() >= kClosingCopy) rows.add(point);
  }
}

/// Smooths a line: a point every kSpacing, which is the mean of the points within kReach, weighted by a
/// triangle. Where an arc meets a straight, the curvature rises along twice the reach. An arc of radius R
/// moves inwards by kReach² / (12 R). The edges stay where they were.
std::vector<road::TrackPoint> eased(const std::vector<road::TrackPoint>& points, bool closed) {
  const auto n = static_cast<std::ptrdiff_t>(points.size());
  const auto at = [&](std::ptrdiff_t i) -> const Vec2& {
    return points[static_cast<std::size_t>((i + n) % n)].position;
  };
  std::vector<double> s{0.0};
  for (std::ptrdiff_t i = 1; i <= n; ++i) s.push_back(s.back() + (at(i) - at(i - 1)).norm());
  const double length = closed ? s.back() : s[points.size() - 1];
  const auto place = [&](std::ptrdiff_t i) {
    const std::ptrdiff_t lap = i < 0 ? -1 : i / n;
    return s[static_cast<std::size_t>(i - lap * n)] + static_cast<double>(lap) * length;
  };
  std::vector<road::TrackPoint> result;
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const double here = place(i);
    const bool is_last = !closed && i + 1 == n;
    if (here < kSpacing * static_cast<double>(result.size()) - 0.5 * kStep && !is_last) continue;
    const double reach = std::min(kReach, closed ? 0.25 * length : std::min(here, length - here));
    road::TrackPoint point = points[static_cast<std::size_t>(i)];
    Vec2 sum = reach * at(i);
    double weights = reach;
    for (const std::ptrdiff_t way : {-1, 1}) {
      for (std::ptrdiff_t j = i + way; std::fabs(place(j) - here) < reach; j += way) {
        const double weight = reach - std::fabs(place(j) - here);
        sum += weight * at(j);
        weights += weight;
      }
    }
    if (weights > 0.0) {
      const Vec2 moved = sum / weights - point.position, chord = at(i + 1) - at(i - 1);
      const double offset = chord.cross(moved) / std::max(chord.norm(), 1e-12);
      point = {point.position + moved, point.left - offset, point.right + offset};
    }
    result.push_back(point);
  }
  return result;
}

}  // namespace

Result<TrackFile> track_of_opendrive(const XmlDocument& xml, const TrackReadOptions& options) {
  std::map<std::string, xml_node> roads;
  std::string at;
  for (const xml_node node : xml.root().children("road")) {
    const std::string id = node.attribute("id").value();
    roads.emplace(id, node);
    if (at.empty()) at = id;
  }
  if (const xml_node junction = xml.root().child("junction"))
    return fail(fault_of(xml.file, xml.line_of(junction), "junction",
                         fmt::format("a network of {} roads", roads.size()), "one course without junctions"));
  if (at.empty()) return fail(fault_of(xml.file, 0, "road", "none", "one"));
  RoadRows rows{xml.file, options};
  const std::string first = at;
  std::set<std::string> driven;
  bool is_forward = true, is_closed = false;
  while (!at.empty() && roads.contains(at) && !rows.error && driven.insert(at).second) {
    lay_out(xml, roads.at(at), is_forward, rows);
    const xml_node next = roads.at(at).child("link").child(is_forward ? "successor" : "predecessor");
    const bool is_road = next.attribute("elementType").value() == std::string_view("road");
    const std::string_view contact = next.attribute("contactPoint").value();
    at = is_road ? next.attribute("elementId").value() : "";
    is_forward = is_forward ? contact != "end" : contact == "start";
    is_closed = at == first && is_forward;
  }
  rows.expect_points(4);
  if (is_closed && !rows.closed) rows.closed = true;
  Result<TrackFile> content = rows.build();
  if (!content) return content;
  warn(*content,
       "lanes: those of type driving, of both directions, taken as one road; heights and banking left out");
  if (driven.size() < roads.size())
    warn(*content, fmt::format("road: {} of {} roads taken, from {} along its successors", driven.size(),
                               roads.size(), printable(first)));
  content->points = eased(content->points, content->is_closed);
  content->options.smoothing_sigma = 0.002 * options.scale;
  return content;
}

}  // namespace chicane::protocol
