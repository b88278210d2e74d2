// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/protocol/track_codec.hpp"

namespace chicane::protocol {

/// A road in one number: the radius of a circle [m].
[[nodiscard]] Result<TrackFile> parse_circle_track(std::string_view text, const std::string& file,
                                                   const TrackReadOptions& options);

inline constexpr TrackFormat kCircleTrack{".circle", &parse_circle_track};

}  // namespace chicane::protocol
