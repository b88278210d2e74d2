// SPDX-License-Identifier: MIT
// Roads in XML files of other programs: the document, and a reader for each dialect. Not installed.
#pragma once

#include <pugixml.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/protocol/detail/road_rows.hpp"

namespace chicane::protocol {

/// XML document whose elements have no namespace prefix.
struct XmlDocument {
  // Chosen: bounds memory and stack.
  static constexpr std::size_t kMostBytes = std::size_t{32} << 20U;  ///< limit of the text [byte]
  static constexpr std::ptrdiff_t kMostTags = 2'000'000;
  static constexpr int kMostDepth = 64;  ///< limit of nesting

  std::string file;  ///< name of the file, for messages
  pugi::xml_document tree = {};
  std::vector<std::ptrdiff_t> line_ends = {};  ///< positions of line breaks in the text

  [[nodiscard]] pugi::xml_node root() const { return tree.document_element(); }
  /// Line on which a node begins, from 1.
  [[nodiscard]] int line_of(pugi::xml_node node) const;
  /// All elements of a name, in the order of the document.
  [[nodiscard]] std::vector<pugi::xml_node> find_all(std::string_view name) const;
};

/// Parses a document. Fails with kParse, "FILE:LINE: …", for text that is not XML, a text or nesting beyond
/// the limits of XmlDocument, and entities that the document declares.
[[nodiscard]] Result<XmlDocument> parse_xml(std::string_view text, const std::string& file);

/// Finite number of an attribute; `otherwise` if the node has none.
[[nodiscard]] double number_at(pugi::xml_node node, const char* attribute, double otherwise = 0.0);

/// Line in geographic coordinates, as a file has it.
struct GeoLine {
  GeoLine(const std::string& file, const TrackReadOptions& options, bool driven = false)
      : rows{file, options, {{"latitude", Column::kLatitude}, {"longitude", Column::kLongitude}}},
        most_noise{driven ? 1.0 : 0.25},
        is_driven{driven} {}

  RoadRows rows;
  double width = 0.0;  ///< [m]; 0: not in the file
  double most_noise;   ///< upper limit of the estimated standard deviation of the points [m]
  bool is_driven;      ///< a log of driving, which may have several laps
};

/// Road in metres east and north of the line's middle. Leaves out points of a car that stands still, and
/// takes the first lap of a log.
[[nodiscard]] Result<TrackFile> track_of_line(GeoLine line);

// Roads of documents, by their root element.
[[nodiscard]] Result<TrackFile> track_of_gpx(const XmlDocument& xml, const TrackReadOptions& options);
[[nodiscard]] Result<TrackFile> track_of_kml(const XmlDocument& xml, const TrackReadOptions& options);
[[nodiscard]] Result<TrackFile> track_of_osm(const XmlDocument& xml, const TrackReadOptions& options);
[[nodiscard]] Result<TrackFile> track_of_opendrive(const XmlDocument& xml, const TrackReadOptions& options);
/// Road between the cones of a Gazebo world.
[[nodiscard]] Result<TrackFile> track_of_sdf(const XmlDocument& xml, const TrackReadOptions& options);

}  // namespace chicane::protocol
