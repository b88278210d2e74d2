// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "chicane/protocol/track_codec.hpp"
#include "chicane/survey/cone_line.hpp"

namespace chicane::protocol {

/// Cones as files have them, with what is no cone.
struct ConeMap {
  survey::Cones cones;
  std::optional<Vec2> start{};
  int unknown = 0;  ///< of no colour that says a side

  /// By what a file calls it: "blue", "cone_yellow", "big_orange", "left", "car_start". False for others.
  bool add(std::string_view tag, const Vec2& place);
};

/// The road between them; gaps are named.
[[nodiscard]] Result<TrackFile> track_of_cones(const ConeMap& map, const std::string& file,
                                               const TrackReadOptions& options);

}  // namespace chicane::protocol
