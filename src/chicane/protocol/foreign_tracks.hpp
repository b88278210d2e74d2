// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "chicane/protocol/track_codec.hpp"

/// Roads as other programs keep them (docs/import.md), each recognised by its content. What a file cannot
/// tell is assumed, and said in TrackFile::warnings with the option of `chicane import` that sets it.
namespace chicane::protocol {

/// All of them; the first that recognises a text reads it.
[[nodiscard]] std::span<const TrackFormat> foreign_tracks() noexcept;

/// What a file of a road is, by its content: "occupancy map", "GPX", "cones", "table of points".
[[nodiscard]] std::string_view road_kind(std::string_view text) noexcept;

/// ROS's map_server: free space of a map with walls. The image is read from beside the file.
[[nodiscard]] Result<TrackFile> parse_map_track(std::string_view text, const std::string& file,
                                                const TrackReadOptions& options);
/// Cones in CSV: rows of x, y and a colour.
[[nodiscard]] Result<TrackFile> parse_csv_cones(std::string_view text, const std::string& file,
                                                const TrackReadOptions& options);
/// Cones in YAML: lists `cones_left` and `cones_right` (FSSIM).
[[nodiscard]] Result<TrackFile> parse_yaml_cones(std::string_view text, const std::string& file,
                                                 const TrackReadOptions& options);
/// Way points of the ForzaETH race stack, and lines of GeoJSON.
[[nodiscard]] Result<TrackFile> parse_json_track(std::string_view text, const std::string& file,
                                                 const TrackReadOptions& options);
/// GPX, KML, OpenStreetMap, OpenDRIVE, and cones in SDF, by the root element.
[[nodiscard]] Result<TrackFile> parse_xml_track(std::string_view text, const std::string& file,
                                                const TrackReadOptions& options);

}  // namespace chicane::protocol
