// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "chicane/protocol/track_codec.hpp"
#include "chicane/road/track.hpp"

namespace chicane::apps {

/// The bytes of a PNG picture of what was recognised: the map or the points of the file in grey, edges black,
/// the line red, the start and its direction green.
[[nodiscard]] std::string preview_of(const road::Track& track, const protocol::TrackFile& content);

}  // namespace chicane::apps
