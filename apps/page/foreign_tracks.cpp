// SPDX-License-Identifier: MIT
// In the place of protocol/foreign_tracks.cpp: the page has no library for images and XML, and reads its own
// files.
#include "chicane/protocol/track_codec.hpp"

namespace chicane::protocol {

std::span<const TrackFormat> foreign_tracks() noexcept { return {}; }

}  // namespace chicane::protocol
