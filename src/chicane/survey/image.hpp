// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/base/result.hpp"

namespace chicane::survey {

/// Grey values, 0 black to 255 white, row by row, the top row first.
struct GreyImage {
  static constexpr std::size_t kMostCells = 64'000'000;  ///< limit of read_image()

  int width = 0, height = 0;
  std::string values = {};
};

/// The bytes of a PGM (P2, P5) or PNG file; `file` for messages. kParse for others, and for more than
/// kMostCells. What is transparent is white. Memory: two bytes for each cell.
[[nodiscard]] Result<GreyImage> read_image(std::string_view bytes, const std::string& file);

/// Distance from the centre of each cell to the centre of the nearest non-zero one [cells], exact
/// (Felzenszwalb and Huttenlocher 2012). A large number if all are zero. Time and memory are proportional to
/// the cells: four bytes each, and two rows.
[[nodiscard]] std::vector<float> distance_field(const std::vector<std::uint8_t>& is_set, int width,
                                                int height);

// Regions of a grid of cells, of free_space.cpp.

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
