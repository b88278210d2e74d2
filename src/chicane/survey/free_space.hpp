// SPDX-License-Identifier: MIT
// Finds a road in an occupancy map: the middle line of free room that leads round an obstacle.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/road/track.hpp"

namespace chicane::survey {

/// Content of a cell of a map.
enum class Cell : std::uint8_t { kFree, kWall, kUnknown };

/// Occupancy map of a place, seen from above, as nav_msgs/OccupancyGrid: square cells in rows.
/// W is the world frame.
struct FreeSpace {
  int width = 0, height = 0;     ///< [cells], > 0
  double resolution = 0.05;      ///< side of a cell [m], > 0
  Vec2 origin{};                 ///< position of the first cell's lower left corner in W [m]
  double yaw = 0.0;              ///< direction of the rows in W [rad]
  std::vector<Cell> cells = {};  ///< row by row, the lowest row first

  /// Position in W [m] of a position in cells, which are counted from the origin.
  [[nodiscard]] Vec2 to_world(const Vec2& in_cells) const noexcept;
  /// Position in cells of a position in W [m].
  [[nodiscard]] Vec2 to_cells(const Vec2& in_world) const noexcept;
};

/// Options of find_loop(). The defaults were chosen for model cars of scale 1:10.
struct LoopOptions {
  double least_width = 0.4;      ///< width below which a passage is no road [m], > 0
  double least_obstacle = 0.25;  ///< diagonal up to which an obstacle on the road is noise [m], >= 0
  std::optional<Vec2>
      start{};  ///< position in W on the wanted road; empty: the road with the largest infield
};

/// Closed road round an obstacle of a map, counter-clockwise.
struct FreeLoop {
  std::vector<road::TrackPoint> points = {};  ///< points in W, evenly spaced
  double median_width = 0.0;                  ///< median of the road's width [m]
  int spots = 0;                              ///< number of obstacles treated as noise
};

/// Middle line of the free room between walls, and its width to each side. Among the loops round the obstacle
/// the search takes a short one, whose length counts more near walls. Unknown cells are no road. A map of
/// more than 16 million cells is coarsened first. Memory: below 20 bytes for each cell.
///
/// Fails with kParse if there is no loop. The message says where the free room is too narrow or open.
[[nodiscard]] Result<FreeLoop> find_loop(const FreeSpace& space, const LoopOptions& options);

}  // namespace chicane::survey
