// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"

namespace chicane::survey {

/// Grey values, 0 black to 255 white, row by row, the top row first.
struct GreyImage {
  static constexpr std::size_t kMostCells = 64'000'000;  ///< of read_image()

  int width = 0, height = 0;
  std::string values = {};
};

/// The bytes of a PGM (P2, P5) or PNG file; `file` for messages. kParse for others, and for more than
/// kMostCells. What is transparent is white. Memory: two bytes for each cell.
[[nodiscard]] Result<GreyImage> read_image(std::string_view bytes, const std::string& file);

/// Red, green, blue.
using Colour = std::array<std::uint8_t, 3>;

/// A picture to draw in, the top row first.
class Picture {
 public:
  /// Pre: 1 to 4096 in each direction.
  Picture(int width, int height, Colour ground);

  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] int height() const noexcept { return height_; }
  /// Outside of the picture nothing happens.
  void set(int x, int y, Colour colour) noexcept;
  /// A line `thickness` pixels wide between two points, cut off at the edges of the picture.
  void draw_line(double x0, double y0, double x1, double y1, Colour colour, int thickness = 1) noexcept;
  /// The bytes of a PNG file.
  [[nodiscard]] std::string png() const;

 private:
  int width_, height_;
  std::vector<std::uint8_t> bytes_;  ///< three for each pixel
};

}  // namespace chicane::survey
