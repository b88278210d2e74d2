// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "chicane/protocol/track_codec.hpp"

/// Steps that the readers of tracks share.
namespace chicane::protocol {

/// An empty file of `file` with the options' scale, widths and noise.
[[nodiscard]] TrackFile empty_track(const std::string& file, const TrackReadOptions& options);

/// Closed or open, as `closed` says or the gap from the last point to the first does: at most 1.5 times the
/// longest other one, or `near` [m]. A closing copy of the first point goes.
void settle_ends(TrackFile& content, std::optional<bool> closed, double near = 0.0);

/// What the options say of direction, start and smoothing. A start given in the file stays at its place.
void arrange(TrackFile& content, const TrackReadOptions& options);
/// The road the other way round.
void reverse(TrackFile& content);
/// A closed road whose points begin with the one nearest to `place`.
void begin_near(TrackFile& content, const Vec2& place);

/// "f.gpx: width: not in the file, 4.5 m left and 4.5 m right assumed (import --width-m sets it)".
void assume_width(TrackFile& content, const TrackReadOptions& options);
/// Adds "f.gpx: what" to the warnings.
void warn(TrackFile& content, std::string_view what);

}  // namespace chicane::protocol
