// SPDX-License-Identifier: MIT
#pragma once

#include <pugixml.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/protocol/detail/road_rows.hpp"

namespace chicane::protocol {

/// An XML document whose elements have no namespace prefix. This header is for our own sources and not
/// installed.
struct XmlDocument {
  static constexpr std::size_t kMostBytes = std::size_t{32} << 20U;  ///< [byte]
  static constexpr std::ptrdiff_t kMostTags = 2'000'000;
  static constexpr int kMostDepth = 64;

  std::string file;
  pugi::xml_document tree = {};
  std::vector<std::ptrdiff_t> line_ends = {};

  [[nodiscard]] pugi::xml_node root() const { return tree.document_element(); }
  /// Line on which a node begins, from 1.
  [[nodiscard]] int line_of(pugi::xml_node node) const;
  /// All elements of a name, in the order of the document.
  [[nodiscard]] std::vector<pugi::xml_node> find_all(std::string_view name) const;
};

/// Parses a document of at most 32 MiB and 2,000,000 tags. Entities of its own are refused. kParse,
/// "FILE:LINE: …", for text that is not XML, more tags or deeper nesting.
[[nodiscard]] Result<XmlDocument> parse_xml(std::string_view text, const std::string& file);

/// The finite number of an attribute; `otherwise` where there is none.
[[nodiscard]] double number_at(pugi::xml_node node, const char* attribute, double otherwise = 0.0);

/// A line on the earth, as a file has it.
struct GeoLine {
  GeoLine(const std::string& file, const TrackReadOptions& options, bool driven = false)
      : rows{file, options, {{"latitude", Column::kLatitude}, {"longitude", Column::kLongitude}}},
        most_noise{driven ? 1.0 : 0.25},
        is_driven{driven} {}

  RoadRows rows;
  double width = 0.0;  ///< [m]; 0: not in the file
  double most_noise;   ///< upper limit of the estimated standard deviation of the places [m]
  bool is_driven;      ///< a log of driving, which may have several laps
};

/// The road in metres east and north of its middle: what stands still is left out, of a log the first lap
/// taken.
[[nodiscard]] Result<TrackFile> track_of_line(GeoLine line);

/// Documents by their root element.
[[nodiscard]] Result<TrackFile> track_of_gpx(const XmlDocument& xml, const TrackReadOptions& options);
[[nodiscard]] Result<TrackFile> track_of_kml(const XmlDocument& xml, const TrackReadOptions& options);
[[nodiscard]] Result<TrackFile> track_of_osm(const XmlDocument& xml, const TrackReadOptions& options);
[[nodiscard]] Result<TrackFile> track_of_opendrive(const XmlDocument& xml, const TrackReadOptions& options);
/// Cones of a world of Gazebo.
[[nodiscard]] Result<TrackFile> track_of_sdf(const XmlDocument& xml, const TrackReadOptions& options);

}  // namespace chicane::protocol
