// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/base/result.hpp"

/// Raster images: grey images from files, and distances and connected regions in a grid of cells, by which
/// free_space.cpp and sampled_line.cpp find roads.

namespace chicane::survey {

/// Grey image: one byte for each cell, row by row, the top row first.
struct GreyImage {
  static constexpr std::size_t kMostCells = 64'000'000;  ///< limit of read_image(): bounds memory; chosen

  int width = 0, height = 0;  ///< [cells]
  std::string values = {};    ///< brightness of each cell, 0 black to 255 white
};

/// Decodes the bytes of a PGM (P2, P5) or PNG file; `file` is its name in messages. Transparent cells become
/// white. Memory: two bytes for each cell. Fails with kParse for other formats and for more than kMostCells.
[[nodiscard]] Result<GreyImage> read_image(std::string_view bytes, const std::string& file);

/// Distance from the centre of each cell to the centre of the nearest set cell [cells], exact (Felzenszwalb
/// and Huttenlocher 2012). A cell is set if its value is not zero; without any the distance is a large
/// number. Time and memory are proportional to the number of cells: four bytes each, and two rows.
[[nodiscard]] std::vector<float> distance_field(const std::vector<std::uint8_t>& is_set, int width,
                                                int height);

/// One value for each cell of a grid, row by row; the cells with a value other than zero are set.
using Mask = std::vector<std::uint8_t>;

/// Column and row of a cell, or the difference of two cells.
struct Place {
  int x = 0, y = 0;
};

/// Steps to the eight neighbours of a cell: four across edges, then four across corners.
inline constexpr Place kNeighbours[8] = {{1, 0}, {0, 1},  {-1, 0},  {0, -1},
                                         {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};

/// Size of a rectangle of cells, and the index of a cell in a vector that holds them row by row.
struct Grid {
  int width = 0, height = 0;  ///< [cells]
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
  /// Calls visit(n, index) for those of the first `count` of kNeighbours of a cell that are in the grid.
  template <class Visit>
  void for_each_neighbour(std::size_t cell, int count, const Visit& visit) const {
    const Place from = place(cell);
    for (int n = 0; n < count; ++n) {
      const int x = from.x + kNeighbours[n].x, y = from.y + kNeighbours[n].y;
      if (has(x, y)) visit(n, at(x, y));
    }
  }
};

/// Connected cells of a mask, with the rectangle round them.
struct Region {
  std::size_t count = 0;                       ///< number of cells
  int left = 0, right = 0, low = 0, high = 0;  ///< first and last column, first and last row
  std::size_t rightmost = 0;                   ///< index of a cell in the last column
  bool is_at_border = false;                   ///< whether a cell lies at the edge of the grid
  /// Diagonal of the rectangle [cells].
  [[nodiscard]] double diagonal() const { return hypot(right - left + 1.0, high - low + 1.0); }
};

/// Connected regions of the set cells of `mask`, across edges (`neighbours` 4) or also across corners (8).
/// `labels` gets one number for each cell: 1 + the index of its region, or 0.
[[nodiscard]] std::vector<Region> regions_of(const Mask& mask, const Grid& grid, int neighbours,
                                             std::vector<int>& labels);

}  // namespace chicane::survey
