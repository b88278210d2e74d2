// SPDX-License-Identifier: MIT
#include "chicane/survey/detail/regions.hpp"

#include <algorithm>

namespace chicane::survey {

std::vector<Region> regions_of(const Mask& mask, const Grid& grid, int neighbours, std::vector<int>& labels) {
  std::vector<Region> regions;
  labels.assign(grid.size(), 0);
  std::vector<std::size_t> open;
  for (std::size_t seed = 0; seed < grid.size(); ++seed) {
    if (mask[seed] == 0 || labels[seed] != 0) continue;
    const Place begin = grid.place(seed);
    Region region{
        .first = seed, .left = begin.x, .right = begin.x, .low = begin.y, .high = begin.y, .rightmost = seed};
    const int label = static_cast<int>(regions.size()) + 1;
    labels[seed] = label;
    open.push_back(seed);
    while (!open.empty()) {
      const std::size_t index = open.back();
      open.pop_back();
      const Place at = grid.place(index);
      ++region.count;
      region.left = std::min(region.left, at.x);
      region.low = std::min(region.low, at.y);
      region.high = std::max(region.high, at.y);
      if (at.x > region.right) region.rightmost = index;
      region.right = std::max(region.right, at.x);
      region.is_at_border =
          region.is_at_border || at.x == 0 || at.y == 0 || at.x + 1 == grid.width || at.y + 1 == grid.height;
      for (int n = 0; n < neighbours; ++n) {
        const int x = at.x + kNeighbours[n].x, y = at.y + kNeighbours[n].y;
        if (!grid.has(x, y)) continue;
        const std::size_t next = grid.at(x, y);
        if (mask[next] == 0 || labels[next] != 0) continue;
        labels[next] = label;
        open.push_back(next);
      }
    }
    regions.push_back(region);
  }
  return regions;
}

}  // namespace chicane::survey
