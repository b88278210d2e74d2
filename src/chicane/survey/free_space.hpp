// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/road/track.hpp"

namespace chicane::survey {

enum class Cell : std::uint8_t { kFree, kWall, kUnknown };

/// A place seen from above as square cells, as maps of ROS have it.
struct FreeSpace {
  int width = 0, height = 0;     ///< [cells], > 0
  double resolution = 0.05;      ///< side of a cell [m], > 0
  Vec2 origin{};                 ///< position of the first cell's lower left corner in W [m]
  double yaw = 0.0;              ///< direction of the rows in W [rad]
  std::vector<Cell> cells = {};  ///< row by row, the lowest row first

  /// A place in W from one in cells, and the other way round.
  [[nodiscard]] Vec2 to_world(const Vec2& in_cells) const noexcept;
  [[nodiscard]] Vec2 to_cells(const Vec2& in_world) const noexcept;
};

struct LoopOptions {
  double least_width = 0.4;      ///< narrower passages are no road [m], > 0
  double least_obstacle = 0.25;  ///< smaller spots within the road are noise of the map [m], >= 0
  std::optional<Vec2>
      start{};  ///< a place in W on the road that is meant; else the road with the largest infield
};

/// A loop round the largest obstacle of free space, counter-clockwise.
struct FreeLoop {
  std::vector<road::TrackPoint> points = {};  ///< points in W, evenly spaced
  double median_width = 0.0;                  ///< [m]
  int spots = 0;                              ///< spots treated as noise
};

/// Middle line of the free room between walls, and its width to each side: among all ways round the infield a
/// short one far from walls. Unknown cells are no road. More than 16 million cells are joined first: memory
/// stays below 20 bytes for each cell.
///
/// kParse if there is no loop: "... open between (3.2, -1.0) and ...", with details of the places.
[[nodiscard]] Result<FreeLoop> find_loop(const FreeSpace& space, const LoopOptions& options);

}  // namespace chicane::survey
