// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "chicane/protocol/track_codec.hpp"
#include "chicane/survey/geodesy.hpp"
#include "chicane/survey/xml_tree.hpp"

namespace chicane::protocol {

/// A line on the earth, as a file has it.
struct GeoLine {
  std::vector<survey::Geographic> places = {};
  double width = 0.0;      ///< [m]; 0: not in the file
  double noise = 0.5;      ///< of the places [m]
  bool is_driven = false;  ///< a log of driving, which may have several laps
};

/// The road in metres east and north of its middle: what stands still is left out, of a log the first lap
/// taken.
[[nodiscard]] Result<TrackFile> track_of_line(const GeoLine& line, const std::string& file,
                                              const TrackReadOptions& options);

/// Documents whose root element is gpx, kml or osm.
[[nodiscard]] Result<TrackFile> track_of_gpx(const survey::XmlNode& root, const std::string& file,
                                             const TrackReadOptions& options);
[[nodiscard]] Result<TrackFile> track_of_kml(const survey::XmlNode& root, const std::string& file,
                                             const TrackReadOptions& options);
[[nodiscard]] Result<TrackFile> track_of_osm(const survey::XmlNode& root, const std::string& file,
                                             const TrackReadOptions& options);

/// Documents whose root element is OpenDRIVE or commonRoad.
[[nodiscard]] Result<TrackFile> track_of_opendrive(const survey::XmlNode& root, const std::string& file,
                                                   const TrackReadOptions& options);
[[nodiscard]] Result<TrackFile> track_of_commonroad(const survey::XmlNode& root, const std::string& file,
                                                    const TrackReadOptions& options);

}  // namespace chicane::protocol
