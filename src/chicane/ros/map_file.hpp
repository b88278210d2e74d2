// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "chicane/base/result.hpp"
#include "chicane/sim/map_scanner.hpp"

namespace chicane::ros {

/// The walls of an occupancy map (protocol/occupancy_map.hpp): cells darker than occupied_thresh; unknown
/// ones are free. Fails as protocol::read_map().
[[nodiscard]] Result<sim::OccupancyGrid> read_map(const std::string& file);

}  // namespace chicane::ros
