// SPDX-License-Identifier: MIT
// Roads from files of many formats, and to files: options, content, formats and their parsers
// (docs/tracks.md).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/road/track.hpp"

namespace chicane::protocol {

/// Options for reading a road's file: values that it lacks, and changes.
struct TrackReadOptions {
  double default_left = 4.5;   ///< width to the left edge in files without widths [m]; (0, kMaxTrackWidth]
  double default_right = 4.5;  ///< width to the right edge in files without widths [m]; (0, kMaxTrackWidth]
  /// Closed or open; none: by the file, or by the gap from its last point to its first.
  std::optional<bool> is_closed = std::nullopt;
  /// Size of the road over full size, by which assumed sizes (widths, noise and spacing of the points) are
  /// multiplied; lengths in the file stay; (0, 1000].
  double scale = 1.0;

  /// Direction of driving, as `chicane import` offers it.
  enum class Direction { kOfTheFile, kReversed, kLeft, kRight };
  Direction direction = Direction::kOfTheFile;           ///< kLeft: a loop to the left, counter-clockwise
  std::optional<Vec2> start = std::nullopt;              ///< start at the point nearest to this one [m]
  std::optional<double> smoothing_sigma = std::nullopt;  ///< replaces the file's or the reader's value [m]
  double least_width = 0.4;                              ///< least width of a map's road [m]; > 0
  std::string columns = {};                              ///< "x_m,y_m,skip": header for a table without one
};

/// Content of a road's file before it becomes a road.
struct TrackFile {
  std::string file;                      ///< name for messages
  std::vector<road::TrackPoint> points;  ///< points; on a closed road the last one does not repeat the first
  std::vector<int> lines;                ///< line of each point in the file, from 1
  bool is_closed = true;
  road::TrackOptions options;         ///< options in the file, else the defaults
  double scale = 1.0;                 ///< scale of TrackReadOptions
  std::vector<std::string> warnings;  ///< "file:line: column: what was assumed or ignored"
};

// Limits of road files. Chosen: beyond any road, to bound memory.
inline constexpr double kMaxTrackWidth = 1000.0;  ///< width to one side [m]
inline constexpr double kMaxTrackScale = 1000.0;
inline constexpr std::size_t kMaxTrackPoints = 1'000'000;
inline constexpr std::size_t kMaxTrackBytes = std::size_t{64} << 20U;  // [byte]

/// Format of road files.
struct TrackFormat {
  std::string_view extension;  ///< ".csv"
  /// Any bytes up to kMaxTrackBytes may be given; time and memory stay bounded. Fails with kParse and one
  /// message "tracks/x.csv:14: w_tr_left_m: got -4, expected a width > 0 and <= 1000 m".
  Result<TrackFile> (*parse)(std::string_view text, const std::string& file,
                             const TrackReadOptions& options) = nullptr;
  /// Recognises a file of this format by its content; nullptr if only the name shows it.
  bool (*recognises)(std::string_view text) noexcept = nullptr;
};

/// Extensions of all formats.
[[nodiscard]] std::span<const std::string_view> track_extensions() noexcept;
/// First format whose extension a file's name has; null if there is none.
[[nodiscard]] const TrackFormat* track_format_of(std::string_view file) noexcept;

/// Whether a format of other programs recognises the text.
[[nodiscard]] bool is_foreign_track(std::string_view text) noexcept;

/// Parses a file by the first format that recognises the content, else by the format of its name, else as
/// CSV.
[[nodiscard]] Result<TrackFile> parse_track(std::string_view text, const std::string& file,
                                            const TrackReadOptions& options = {});

/// Road of a file's content: smoothed and checked (road::Track::create), named after the file. Fails with
/// kParse; faults of a point name its line.
[[nodiscard]] Result<road::Track> make_track(const TrackFile& content);

/// Road of a file: read_file(), parse_track() and make_track(), whose errors it passes on.
[[nodiscard]] Result<road::Track> read_track(const std::string& file, const TrackReadOptions& options = {});

// Roads as CSV files (docs/tracks.md): waypoints `x,y`, TUM centre lines `x_m,y_m,w_tr_right_m,w_tr_left_m`,
// TUM race lines `s_m; x_m; y_m; psi_rad; kappa_radpm; vx_mps; ax_mps2` with or without widths. Columns are
// found by name.

/// Parser of a table of points, as TrackFormat::parse. Numbers have a decimal point in every locale; `;`,
/// `,`, tab or blanks separate them; CRLF, a byte-order mark, blank lines and comments after `#` or `%` are
/// allowed. A table without a header has the columns x and y, or is refused.
[[nodiscard]] Result<TrackFile> parse_csv_track(std::string_view text, const std::string& file,
                                                const TrackReadOptions& options);

/// Table in TUM's centre-line format, with `description` as a comment at the top. parse_csv_track() reads it
/// back bit for bit.
[[nodiscard]] std::string write_csv_track(const TrackFile& content, std::string_view description);

/// Format of tables of points.
inline constexpr TrackFormat kCsvTrack{".csv", &parse_csv_track};

// Formats of other programs (docs/tracks.md), each recognised by its content. Values that a file lacks are
// assumed, and named in TrackFile::warnings with the option of `chicane import` that sets them.

/// Formats of other programs; the first one that recognises a text reads it.
[[nodiscard]] std::span<const TrackFormat> foreign_tracks() noexcept;

/// Names of road files for the help.
inline constexpr std::string_view kRoadFiles =
    "Map (.yaml with its image), table, cones, JSON, GPX, KML, OSM or OpenDRIVE";
/// Kind of a road's file, by its content: "occupancy map", "GPX", "cones", "table of points".
[[nodiscard]] std::string_view road_kind(std::string_view text) noexcept;

/// ROS's map_server: free space of a map with walls. The image is read from the file's folder.
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
