// SPDX-License-Identifier: MIT
// Rows of points of a road file, checked cell by cell, and their conversion to a road.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/protocol/track_codec.hpp"

namespace chicane::protocol {

/// Distance [m] up to which a point repeats another one; chosen: the last digit that files have.
inline constexpr double kClosingCopy = 1e-3;

/// Error of a cell: "f.csv:3: x_m: got abc, expected a finite number"; line 0: of the whole file.
[[nodiscard]] Error fault_of(std::string_view file, int line, std::string_view key, std::string_view got,
                             std::string_view expected);
/// Adds "f.csv:3: what" to the warnings; line 0: of the whole file.
void warn(TrackFile& content, std::string_view what, int line = 0);
/// Warns that the file has no widths, and of the assumed ones.
void warn_of_width(TrackFile& content, const TrackReadOptions& options, int line = 0);

/// Reverses the driving direction of a road.
void reverse(TrackFile& content);
/// Sets the start to the point nearest to `place`, which becomes the first one of a closed road.
void begin_near(TrackFile& content, const Vec2& place);
/// Applies direction, start and smoothing of the options. Without a start in the options, the file's start
/// stays at its point.
void arrange(TrackFile& content, const TrackReadOptions& options);

/// Length that a table may set in a comment: "# start_s_m=12.5".
struct TrackSetting {
  std::string_view key;
  double road::TrackOptions::*length;
};
inline constexpr std::array kTrackSettings{
    TrackSetting{"start_s_m", &road::TrackOptions::start_s},
    TrackSetting{"finish_s_m", &road::TrackOptions::finish_s},
    TrackSetting{"start_d_m", &road::TrackOptions::start_d},
    TrackSetting{"spacing_m", &road::TrackOptions::spacing},
    TrackSetting{"smoothing_sigma_m", &road::TrackOptions::smoothing_sigma},
    TrackSetting{"kerb_width_m", &road::TrackOptions::kerb_width},
};

/// Quantity in a column of a road's file.
enum class Column : std::uint8_t {
  kX,
  kY,
  kLongitude,
  kLatitude,
  kRight,
  kLeft,
  kWidth,
  kHeading,
  kTag,      ///< colour or side of a cone
  kSkipped,  ///< known, and computed from the points
  kUnknown
};

/// Rows of points of a file, checked cell by cell. The first fault is stored in `error`, with which build()
/// fails; a reader may go on after it.
struct RoadRows {
  /// Column by the name that the file has for it.
  struct Named {
    std::string name;  ///< name in messages
    Column column = Column::kUnknown;
  };

  RoadRows(const std::string& file, const TrackReadOptions& read_options, std::vector<Named> named = {});

  [[nodiscard]] bool has(Column column) const;
  /// Adds a row with a cell for each column; further cells are ignored. Widths without a column are the
  /// options'.
  void add(int line, std::span<const std::string_view> cells, char separator = ',');
  void add(int line, std::initializer_list<std::string_view> cells) {
    add(line, {cells.begin(), cells.size()});
  }
  void add(const road::TrackPoint& point);

  /// Stores a fault (fault_of()) if it is the first one.
  void fault(int line, std::string_view key, std::string_view got, std::string_view expected);
  /// Stores a fault if there are fewer than `least` points.
  void expect_points(std::size_t least);

  /// Road of the rows, closed or open. Drops a last point that repeats the first of a closed road.
  [[nodiscard]] Result<TrackFile> build();

  TrackReadOptions options;
  std::vector<Named> columns;
  TrackFile content;              ///< points in longitude and latitude (x, y) if those are the columns
  std::vector<double> headings;   ///< values of the column kHeading [rad]
  std::vector<std::string> tags;  ///< values of the column kTag, in lower case
  std::string list =
      {};  ///< name of the list for files whose rows have an index in a list, not a line: "wpnts"
  /// Whether the road is closed, by options or file. None: by the gap from the last point to the first, which
  /// in a closed road is at most `meets` [m] or 1.5 times the longest other gap.
  std::optional<bool> closed = options.is_closed;
  double meets = 0.0;
  std::optional<Error> error;  ///< first fault
};

/// Reads the rows of a table. Its header names the columns, or TrackReadOptions::columns does. A table of
/// cones
/// (`has_tags`) has a column kTag, which without a header is the first one, before x and y.
[[nodiscard]] RoadRows read_table(std::string_view text, const std::string& file,
                                  const TrackReadOptions& options, bool has_tags = false);

}  // namespace chicane::protocol
