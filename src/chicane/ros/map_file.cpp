// SPDX-License-Identifier: MIT
#include "chicane/ros/map_file.hpp"

#include "chicane/protocol/occupancy_map.hpp"

namespace chicane::ros {

Result<sim::OccupancyGrid> read_map(const std::string& file) {
  const Result<protocol::OccupancyMap> map = protocol::read_map(file);
  if (!map) return fail(map.error());
  sim::OccupancyGrid grid{.width = map->image.width,
                          .height = map->image.height,
                          .resolution = map->resolution,
                          .origin = {.x = map->origin.x(), .y = map->origin.y(), .psi = map->yaw}};
  grid.is_wall.reserve(map->image.values.size());
  for (int y = map->image.height - 1; y >= 0; --y)  // the image begins at the top
    for (int x = 0; x < map->image.width; ++x) grid.is_wall.push_back(map->darkness(x, y) > map->occupied);
  return grid;
}

}  // namespace chicane::ros
