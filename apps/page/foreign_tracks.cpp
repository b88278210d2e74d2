// SPDX-License-Identifier: MIT
// Replaces protocol/foreign_tracks.cpp in the page, which has no library for images and XML and reads its own
// files only.
#include "chicane/protocol/track_codec.hpp"

namespace chicane::protocol {

std::span<const TrackFormat> foreign_tracks() noexcept { return {}; }

}  // namespace chicane::protocol
