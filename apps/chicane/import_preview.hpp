// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "chicane/protocol/track_codec.hpp"
#include "chicane/road/track.hpp"

namespace chicane::apps {

/// A document (protocol/report_document.hpp) with `words` and a map of what was recognised: the map or the
/// points of the file, edges, line, start and its direction.
[[nodiscard]] std::string preview_of(const road::Track& track, const protocol::TrackFile& content,
                                     const std::string& words);

}  // namespace chicane::apps
