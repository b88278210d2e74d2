// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/path/track.hpp"

/// Roads as CSV files (docs/tracks.md): waypoints `x,y`, TUM centre lines `x_m,y_m,w_tr_right_m,w_tr_left_m`,
/// TUM race lines `s_m; x_m; y_m; psi_rad; kappa_radpm; vx_mps; ax_mps2` with or without widths. Columns are
/// found by name.
namespace chicane::protocol {

struct TrackReadOptions {
  double default_left = 4.5;   ///< where a file has no widths [m], > 0
  double default_right = 4.5;  ///< [m], > 0
  std::optional<bool> is_closed =
      std::nullopt;  ///< forces it; else the file's `# closed=...` or the gap from last to first point says
};

/// What a file holds, before it becomes a road.
struct TrackFile {
  std::string file;                      ///< for messages
  std::vector<path::TrackPoint> points;  ///< a closing copy of the first point is taken away
  std::vector<int> lines;                ///< of each point in the file, from 1
  bool is_closed = true;
  path::TrackOptions options;  ///< from comments `# start_s_m=258, kerb_width_m=0.5`, else the defaults
  std::vector<std::string> warnings;  ///< "file:line: column: what was assumed or ignored"
};

inline constexpr std::size_t kMaxTrackPoints = 1'000'000;
inline constexpr std::size_t kMaxTrackBytes = std::size_t{64} << 20U;

/// Any bytes may be given; time and memory stay bounded. Numbers have a decimal point in every locale; `;`,
/// `,`, tab or blanks separate them; CRLF, a byte-order mark, blank lines and `#` comments are fine. Fails
/// with kParse and one message "tracks/x.csv:14: w_tr_left_m: got -4, expected a width > 0 and <= 1000 m".
[[nodiscard]] Result<TrackFile> parse_track(std::string_view text, const std::string& file,
                                            const TrackReadOptions& options = {});

/// The road: smoothed, checked (path::Track::create); named after the file. Fails with kParse; faults of a
/// point have its line.
[[nodiscard]] Result<path::Track> make_track(const TrackFile& content);

/// Reads, parses and makes. Also kNotFound and kIo. Warnings are appended to `warnings` when given.
[[nodiscard]] Result<path::Track> read_track(const std::string& file, const TrackReadOptions& options = {},
                                             std::vector<std::string>* warnings = nullptr);

/// TUM centre-line format that parse_track() reads back bit for bit, opening with `description` as a comment.
[[nodiscard]] std::string write_track(const TrackFile& content, std::string_view description);

}  // namespace chicane::protocol
