// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/survey/free_space.hpp"
#include "chicane/survey/image.hpp"

namespace chicane::protocol {

/// An occupancy map as ROS's map_server, SLAM Toolbox and F1TENTH keep it.
struct OccupancyMap {
  survey::GreyImage image = {};
  double resolution = 0.0;  ///< side of a cell [m], > 0
  Vec2 origin{};            ///< position of the image's lower left corner in W [m]
  double yaw = 0.0;         ///< direction of the image's rows in W [rad]
  double occupied = 0.65;   ///< darker cells are walls; [0, 1]
  double free = 0.196;      ///< lighter cells are free, others unknown; [0, 1]
  bool is_negated = false;  ///< light is wall

  /// Darkness of a cell, 0 free to 1 wall; y counts from the image's top row.
  [[nodiscard]] double darkness(int x, int y) const noexcept {
    return (is_negated ? grey(x, y) : 255 - grey(x, y)) / 255.0;
  }
  /// Whether a cell has the grey that map_saver writes for unknown ones. The grey is lighter than the
  /// free_thresh of 0.25 that nav2 writes in the same file.
  [[nodiscard]] bool is_unknown(int x, int y) const noexcept {
    constexpr int kUnknown = 205;
    return !is_negated && grey(x, y) == kUnknown;
  }

 private:
  [[nodiscard]] int grey(int x, int y) const noexcept {
    return static_cast<unsigned char>(
        image.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                     static_cast<std::size_t>(x)]);
  }
};

/// The map of a YAML file that names an image (PGM or PNG), resolution [m], origin [x, y, yaw], negate,
/// occupied_thresh and free_thresh; the image is in the file's folder. Modes "trinary" and "scale"; "raw" is
/// refused. Fails with kNotFound, kIo, or kParse: "map.yaml:3: resolution: got -1, expected ...".
[[nodiscard]] Result<OccupancyMap> parse_map(std::string_view text, const std::string& file);
/// The same of a file.
[[nodiscard]] Result<OccupancyMap> read_map(const std::string& file);

/// Cells of a map as walls, free room and unknown.
[[nodiscard]] survey::FreeSpace free_space_of(const OccupancyMap& map);

}  // namespace chicane::protocol
