// SPDX-License-Identifier: MIT
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

inline constexpr double kClosingCopy = 1e-3;  ///< a point this near to another one repeats it [m]

/// Error of a cell: "f.csv:3: x_m: got abc, expected a finite number"; line 0: of the whole file.
[[nodiscard]] Error fault_of(std::string_view file, int line, std::string_view key, std::string_view got,
                             std::string_view expected);
/// Adds "f.csv:3: what" to the warnings; line 0: of the whole file.
void warn(TrackFile& content, std::string_view what, int line = 0);
/// Says that the file has no widths.
void warn_of_width(TrackFile& content, const TrackReadOptions& options, int line = 0);

/// The road the other way round.
void reverse(TrackFile& content);
/// A closed road whose points begin with the one nearest to `place`.
void begin_near(TrackFile& content, const Vec2& place);
/// Direction, start and smoothing as the options want them. A start given in the file stays at its place.
void arrange(TrackFile& content, const TrackReadOptions& options);

/// Lengths that a table says in comments: "# start_s_m=12.5".
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

/// Rows of points as a reader finds them in a file, checked cell by cell. The first fault is kept: a reader
/// may continue or stop, build() fails with it.
struct RoadRows {
  struct Named {
    std::string name;  ///< name of the file, for messages
    Column column = Column::kUnknown;
  };

  RoadRows(const std::string& file, const TrackReadOptions& read_options, std::vector<Named> named = {});

  [[nodiscard]] bool has(Column column) const;
  /// A row with a cell for each column; more are left out. Widths that are in no column come from the
  /// options.
  void add(int line, std::span<const std::string_view> cells, char separator = ',');
  void add(int line, std::initializer_list<std::string_view> cells) {
    add(line, {cells.begin(), cells.size()});
  }
  void add(const road::TrackPoint& point);

  void fault(int line, std::string_view key, std::string_view got, std::string_view expected);
  void expect_points(std::size_t least);

  /// The road. A closing copy of the first point goes.
  [[nodiscard]] Result<TrackFile> build();

  TrackReadOptions options;
  std::vector<Named> columns;
  TrackFile content;  ///< x and y of a point are longitude and latitude where those are the columns
  std::vector<double> headings;  ///< headings of a column [rad]
  std::vector<std::string> tags;
  std::string list = {};  ///< "wpnts", where rows have a number in a list in place of a line
  /// Closed or open as options or file say; else by the gap from the last point to the first: a loop's is at
  /// most 1.5 times the longest other one, or `meets` [m].
  std::optional<bool> closed = options.is_closed;
  double meets = 0.0;
  std::optional<Error> error;
};

/// Rows of CSV. A table has its columns by the names in it, or by TrackReadOptions::columns; one of cones has
/// a column kTag, which comes first, before x and y, where nothing is named.
[[nodiscard]] RoadRows read_table(std::string_view text, const std::string& file,
                                  const TrackReadOptions& options, bool has_tags = false);

}  // namespace chicane::protocol
