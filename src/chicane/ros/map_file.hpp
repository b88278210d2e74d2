// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/sim/map_scanner.hpp"

namespace chicane::ros {

/// An occupancy map as ROS's map_server reads it: a YAML file that names an image (PGM, and PNG where this
/// was built with libpng), resolution [m], origin [x, y, yaw], negate, occupied_thresh and free_thresh. Cells
/// darker than occupied_thresh are walls; unknown ones are free. Also of the modes "trinary" and
/// "scale"; "raw" is refused. Fails with kNotFound, kIo, or kParse: "map.yaml:3: resolution: got -1, expected
/// ...".
[[nodiscard]] Result<sim::OccupancyGrid> read_map(const std::string& file);

/// Grey values, 0 black to 255 white, row by row, the top row first.
struct GreyImage {
  int width = 0, height = 0;
  std::string values = {};
};
/// The bytes of a PGM (P2, P5) or PNG file; `file` for messages. kParse for others, and for more cells than
/// OccupancyGrid::kMostCells. What is transparent is white.
[[nodiscard]] Result<GreyImage> read_image(std::string_view bytes, const std::string& file);

}  // namespace chicane::ros
