// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/protocol/track_codec.hpp"

/// Roads as CSV files (docs/tracks.md): waypoints `x,y`, TUM centre lines `x_m,y_m,w_tr_right_m,w_tr_left_m`,
/// TUM race lines `s_m; x_m; y_m; psi_rad; kappa_radpm; vx_mps; ax_mps2` with or without widths. Columns are
/// found by name.
namespace chicane::protocol {

/// What TrackFormat::parse describes. Numbers have a decimal point in every locale; `;`, `,`, tab or blanks
/// separate them; CRLF, a byte-order mark, blank lines and comments behind `#` or `%` are fine. Nothing is
/// guessed but that two columns without names are x and y.
[[nodiscard]] Result<TrackFile> parse_csv_track(std::string_view text, const std::string& file,
                                                const TrackReadOptions& options);

/// TUM centre-line format that parse_csv_track() reads back bit for bit, opening with `description` as a
/// comment.
[[nodiscard]] std::string write_csv_track(const TrackFile& content, std::string_view description);

inline constexpr TrackFormat kCsvTrack{".csv", &parse_csv_track};

}  // namespace chicane::protocol
