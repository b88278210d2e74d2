// SPDX-License-Identifier: MIT
// Canvas: a picture in memory with filled shapes, lines and text, drawn without a graphics library.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "chicane/base/vec2.hpp"

namespace chicane::recording {

/// Calls `stroke(x0, y0, x1, y1)` for each line of a letter: base line at y = 0, top of a capital at 1, y up,
/// width about 0.6. Draws digits, letters of ASCII (small ones as capitals) and some signs; nothing for
/// others.
void for_each_stroke(char letter, const std::function<void(double, double, double, double)>& stroke);

/// Colour of a shape.
struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
  double opacity = 1.0;  ///< [0, 1]; 1 hides what is below
};

/// Picture of plain shapes with smooth edges. Coordinates are pixels from the upper left corner, y down;
/// shapes are clipped. Deterministic.
class Canvas {
 public:
  Canvas(int width, int height);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// Three bytes for each pixel, row by row: red, green, blue.
  [[nodiscard]] std::span<const std::uint8_t> bytes() const { return bytes_; }

  /// Fills the whole picture.
  void clear(const Colour& colour);
  /// Fills closed rings. A ring within another, in the opposite direction, is a hole.
  void fill(const std::vector<std::vector<Vec2>>& rings, const Colour& colour);
  void line(std::span<const Vec2> points, double thickness, const Colour& colour);
  void disc(const Vec2& centre, double radius, const Colour& colour);
  void rectangle(double x, double y, double width, double height, const Colour& colour);
  /// Draws text from x on, with its base line at y and capitals `size` pixels tall; letters without strokes
  /// stay blank. Returns the x where the text ends.
  double text(double x, double y, double size, std::string_view words, const Colour& colour);
  /// Width of that text.
  [[nodiscard]] static double text_width(double size, std::string_view words);

 private:
  /// Adds an edge of the current shape: the signed area to its right, row by row. Sums along a row then give
  /// the exact cover of each pixel.
  void add_edge(Vec2 from, Vec2 to);
  /// Adds a bar with half a thickness beyond both ends, in one direction of rotation.
  void add_stroke(const Vec2& from, const Vec2& to, double thickness);
  /// Paints the current shape, and begins another one.
  void paint(const Colour& colour);

  int width_, height_;               ///< size [px]
  std::vector<std::uint8_t> bytes_;  ///< bytes()
  std::vector<float> cover_;         ///< change of the current shape's cover from pixel to pixel
  int first_row_, last_row_;         ///< rows of the current shape
};

}  // namespace chicane::recording
