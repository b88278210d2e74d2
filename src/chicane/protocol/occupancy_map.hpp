// SPDX-License-Identifier: MIT
// Occupancy maps of ROS: a grey image with its scale and place, read from YAML and image.
#pragma once

#include <string>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/survey/free_space.hpp"
#include "chicane/survey/image.hpp"

namespace chicane::protocol {

/// Occupancy map of ROS's map_server, SLAM Toolbox and F1TENTH.
struct OccupancyMap {
  survey::GreyImage image = {};
  double resolution = 0.0;  ///< side of a cell [m], > 0
  Vec2 origin{};            ///< position of the image's lower left corner in W [m]
  double yaw = 0.0;         ///< direction of the image's rows in W [rad]
  double occupied = 0.65;   ///< darkness above which cells are walls; [0, 1]
  double free = 0.196;      ///< darkness below which cells are free; others are unknown; [0, 1]
  bool is_negated = false;  ///< walls are light

  /// Darkness of a cell, 0 free to 1 wall; y counts from the image's top row.
  [[nodiscard]] double darkness(int x, int y) const noexcept {
    return (is_negated ? grey(x, y) : 255 - grey(x, y)) / 255.0;
  }
  /// Whether a cell has the grey that map_saver writes for unknown ones. The grey is lighter than the
  /// free_thresh of 0.25 that nav2 writes in the same file.
  [[nodiscard]] bool is_unknown(int x, int y) const noexcept {
    constexpr int kUnknown = 205;  // value of map_saver
    return !is_negated && grey(x, y) == kUnknown;
  }

 private:
  [[nodiscard]] int grey(int x, int y) const noexcept {
    return static_cast<unsigned char>(
        image.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                     static_cast<std::size_t>(x)]);
  }
};

/// Parses the YAML file of a map that names an image (PGM or PNG), resolution [m], origin [x, y, yaw],
/// negate, occupied_thresh and free_thresh; the image is in the file's folder. Modes "trinary" and "scale";
/// "raw" is refused. Fails with kNotFound, kIo, or kParse: "map.yaml:3: resolution: got -1, expected ...".
[[nodiscard]] Result<OccupancyMap> parse_map(std::string_view text, const std::string& file);
/// Reads and parses the YAML file of a map.
[[nodiscard]] Result<OccupancyMap> read_map(const std::string& file);

/// Cells of a map as walls, free and unknown ones.
[[nodiscard]] survey::FreeSpace free_space_of(const OccupancyMap& map);

}  // namespace chicane::protocol
