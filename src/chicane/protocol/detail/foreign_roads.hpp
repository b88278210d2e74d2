// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "chicane/protocol/detail/road_rows.hpp"
#include "chicane/protocol/detail/xml_document.hpp"

namespace chicane::protocol {

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
