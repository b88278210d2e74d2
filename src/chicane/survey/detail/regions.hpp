// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "chicane/base/math.hpp"

/// Regions of a grid of cells, of free_space.cpp.
namespace chicane::survey {

using Mask = std::vector<std::uint8_t>;

/// A pair of cell numbers; all grids here are walked by them.
struct Place {
  int x = 0, y = 0;
};

struct Grid {
  int width = 0, height = 0;
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  [[nodiscard]] bool has(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
  [[nodiscard]] Place place(std::size_t index) const {
    const auto columns = static_cast<std::size_t>(width);
    return {static_cast<int>(index % columns), static_cast<int>(index / columns)};
  }
};

inline constexpr Place kNeighbours[8] = {{1, 0}, {0, 1},  {-1, 0},  {0, -1},
                                         {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};

/// Cells of one kind that hang together.
struct Region {
  std::size_t first = 0, count = 0;
  int left = 0, right = 0, low = 0, high = 0;
  std::size_t rightmost = 0;
  bool is_at_border = false;
  [[nodiscard]] double diagonal() const { return hypot(right - left + 1.0, high - low + 1.0); }
};

/// Numbers the regions of `mask` from 1 on in `labels`, across corners where `neighbours` is 8.
[[nodiscard]] std::vector<Region> regions_of(const Mask& mask, const Grid& grid, int neighbours,
                                             std::vector<int>& labels);

}  // namespace chicane::survey
