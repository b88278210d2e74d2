// SPDX-License-Identifier: MIT
// Canvas for pictures: a font of strokes, and shapes filled by the exact cover of each pixel.
#include "chicane/recording/detail/canvas.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "chicane/base/math.hpp"

namespace chicane::recording {
namespace {

/// Letter as lines between points of a grid, 0 to 4 to the right and 0 to 6 upwards: "04 44" is a stroke from
/// (0, 4) to (4, 4), a comma lifts the pen.
struct Glyph {
  char letter;
  std::string_view path;
};

constexpr std::array kGlyphs{
    Glyph{'0', "10 01 05 16 36 45 41 30 10,11 35"},
    Glyph{'1', "15 26 20,10 30"},
    Glyph{'2', "05 16 36 45 44 00 40"},
    Glyph{'3', "05 16 36 45 44 33 13,33 42 41 30 10 01"},
    Glyph{'4', "30 36 02 42"},
    Glyph{'5', "46 06 03 33 42 41 30 10 01"},
    Glyph{'6', "45 36 16 05 01 10 30 41 42 33 03"},
    Glyph{'7', "06 46 10"},
    Glyph{'8', "13 04 05 16 36 45 44 33 13 02 01 10 30 41 42 33"},
    Glyph{'9', "01 10 30 41 45 36 16 05 04 13 43"},
    Glyph{'A', "00 04 26 44 40,03 43"},
    Glyph{'B', "00 06 36 45 44 33 03,33 42 41 30 00"},
    Glyph{'C', "45 36 16 05 01 10 30 41"},
    Glyph{'D', "00 06 26 44 42 20 00"},
    Glyph{'E', "40 00 06 46,03 33"},
    Glyph{'F', "00 06 46,03 33"},
    Glyph{'G', "45 36 16 05 01 10 30 41 43 23"},
    Glyph{'H', "00 06,40 46,03 43"},
    Glyph{'I', "10 30,20 26,16 36"},
    Glyph{'J', "01 10 20 31 36"},
    Glyph{'K', "00 06,46 03 40"},
    Glyph{'L', "06 00 40"},
    Glyph{'M', "00 06 23 46 40"},
    Glyph{'N', "00 06 40 46"},
    Glyph{'O', "10 01 05 16 36 45 41 30 10"},
    Glyph{'P', "00 06 36 45 44 33 03"},
    Glyph{'Q', "10 01 05 16 36 45 41 30 10,22 40"},
    Glyph{'R', "00 06 36 45 44 33 03,23 40"},
    Glyph{'S', "45 36 16 05 04 13 33 42 41 30 10 01"},
    Glyph{'T', "20 26,06 46"},
    Glyph{'U', "06 01 10 30 41 46"},
    Glyph{'V', "06 20 46"},
    Glyph{'W', "06 10 23 30 46"},
    Glyph{'X', "00 46,06 40"},
    Glyph{'Y', "06 23 46,23 20"},
    Glyph{'Z', "06 46 00 40"},
    Glyph{'.', "20 21"},
    Glyph{',', "10 21"},
    Glyph{':', "21 22,24 25"},
    Glyph{'+', "03 43,21 25"},
    Glyph{'-', "03 43"},
    Glyph{'_', "00 40"},
    Glyph{'/', "00 46"},
    Glyph{'%', "00 46,04 05,41 42"},
    Glyph{'(', "30 21 25 36"},
    Glyph{')', "10 21 25 16"},
};

constexpr double kAcross = 0.15, kUp = 1.0 / 6.0;  // steps of the grid, in sizes of letters; chosen

}  // namespace

void for_each_stroke(char letter, const std::function<void(double, double, double, double)>& stroke) {
  if (letter >= 'a' && letter <= 'z') letter = static_cast<char>(letter - 'a' + 'A');
  for (const Glyph& glyph : kGlyphs) {
    if (glyph.letter != letter) continue;
    for (std::size_t i = 0; i + 4 < glyph.path.size(); i += 3) {
      if (glyph.path[i + 2] == ',') continue;
      const auto across = [&](std::size_t at) { return kAcross * (glyph.path[at] - '0'); };
      const auto up = [&](std::size_t at) { return kUp * (glyph.path[at + 1] - '0'); };
      stroke(across(i), up(i), across(i + 3), up(i + 3));
    }
    return;
  }
}

namespace {

// Chosen.
constexpr double kAdvance = 0.82;           // step from letter to letter, in sizes of letters
constexpr double kStroke = 0.13;            // thickness of letters, in their sizes
constexpr int kDiscCorners = 24;            // corners of the polygon that stands for a disc
constexpr double kInvisible = 1.0 / 512.0;  // share below which a colour changes no byte

/// Mixture of two bytes of colour, with `share` of the upper one.
std::uint8_t mixed(std::uint8_t below, std::uint8_t above, double share) {
  return static_cast<std::uint8_t>(std::lround(below + share * (above - below)));
}

}  // namespace

Canvas::Canvas(int width, int height)
    : width_{width},
      height_{height},
      bytes_(static_cast<std::size_t>(3 * width * height)),
      cover_(static_cast<std::size_t>((width + 2) * height)),
      first_row_{height},
      last_row_{-1} {}

void Canvas::clear(const Colour& colour) {
  for (std::size_t i = 0; i < bytes_.size(); i += 3) {
    bytes_[i] = colour.red;
    bytes_[i + 1] = colour.green;
    bytes_[i + 2] = colour.blue;
  }
}

void Canvas::add_edge(Vec2 from, Vec2 to) {
  if (!(std::isfinite(from.x() + from.y() + to.x() + to.y())) || from.y() == to.y()) return;
  const double sign = from.y() < to.y() ? 1.0 : -1.0;
  if (sign < 0.0) std::swap(from, to);
  const double slope = (to.x() - from.x()) / (to.y() - from.y());
  const double top = std::max(from.y(), 0.0), bottom = std::min(to.y(), static_cast<double>(height_));
  if (top >= bottom) return;
  const int begin = static_cast<int>(top);
  const int end = std::min(height_, static_cast<int>(std::ceil(bottom)));
  first_row_ = std::min(first_row_, begin);
  last_row_ = std::max(last_row_, end - 1);
  for (int row = begin; row < end; ++row) {
    const double y0 = std::max(top, static_cast<double>(row));
    const double y1 = std::min(bottom, static_cast<double>(row + 1));
    const double most = width_;
    const double x0 = std::clamp(from.x() + slope * (y0 - from.y()), 0.0, most);
    const double x1 = std::clamp(from.x() + slope * (y1 - from.y()), 0.0, most);
    const double left = std::min(x0, x1), right = std::max(x0, x1);
    float* const cells = &cover_[static_cast<std::size_t>(row * (width_ + 2))];
    const double height = sign * (y1 - y0);
    // Spread `height` over the pixels that the edge crosses in this row, by the area to its right in each of
    // them.
    const int first = static_cast<int>(left), last = static_cast<int>(right);
    if (first == last) {
      const double covered = 1.0 - (0.5 * (left + right) - first);
      cells[first] += static_cast<float>(height * covered);
      cells[first + 1] += static_cast<float>(height * (1.0 - covered));
      continue;
    }
    double before = 0.0;  // area right of the edge up to the pixel before
    for (int x = first; x <= last; ++x) {
      const double a = std::max(left, static_cast<double>(x)), b = std::min(right, x + 1.0);
      const double low = (a - left) / (right - left), high = (b - left) / (right - left);
      const double area = low * (a - x) + 0.5 * (low + high) * (b - a) + high * (x + 1.0 - b);
      cells[x] += static_cast<float>(height * (area - before));
      before = area;
    }
    cells[last + 1] += static_cast<float>(height * (1.0 - before));
  }
}

void Canvas::paint(const Colour& colour) {
  for (int row = first_row_; row <= last_row_; ++row) {
    float* const cells = &cover_[static_cast<std::size_t>(row * (width_ + 2))];
    float sum = 0.0F;
    for (int x = 0; x < width_; ++x) {
      sum += cells[x];
      const double share = std::min(std::fabs(static_cast<double>(sum)), 1.0) * colour.opacity;
      if (share < kInvisible) continue;
      std::uint8_t* const pixel = &bytes_[static_cast<std::size_t>(3 * (row * width_ + x))];
      pixel[0] = mixed(pixel[0], colour.red, share);
      pixel[1] = mixed(pixel[1], colour.green, share);
      pixel[2] = mixed(pixel[2], colour.blue, share);
    }
    std::fill(cells, cells + width_ + 2, 0.0F);
  }
  first_row_ = height_;
  last_row_ = -1;
}

void Canvas::fill(const std::vector<std::vector<Vec2>>& rings, const Colour& colour) {
  for (const std::vector<Vec2>& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) add_edge(ring[i], ring[(i + 1) % ring.size()]);
  paint(colour);
}

void Canvas::add_stroke(const Vec2& from, const Vec2& to, double thickness) {
  const Vec2 way = to - from;
  const double length = std::sqrt(way.x() * way.x() + way.y() * way.y());
  const Vec2 along = length > 1e-9 ? Vec2(0.5 * thickness / length * way) : Vec2{0.5 * thickness, 0.0};
  const Vec2 across{-along.y(), along.x()};
  const Vec2 a = from - 0.5 * along, b = to + 0.5 * along;
  const std::array<Vec2, 4> corners{a + across, b + across, b - across, a - across};
  for (std::size_t i = 0; i < corners.size(); ++i) add_edge(corners[i], corners[(i + 1) % corners.size()]);
}

void Canvas::line(std::span<const Vec2> points, double thickness, const Colour& colour) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) add_stroke(points[i], points[i + 1], thickness);
  paint(colour);
}

void Canvas::disc(const Vec2& centre, double radius, const Colour& colour) {
  std::vector<Vec2> ring;
  for (int i = 0; i < kDiscCorners; ++i) {
    const double angle = 2.0 * kPi * i / kDiscCorners;
    ring.emplace_back(centre.x() + radius * cos(angle), centre.y() + radius * sin(angle));
  }
  fill({ring}, colour);
}

void Canvas::rectangle(double x, double y, double width, double height, const Colour& colour) {
  fill({{{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}}}, colour);
}

double Canvas::text(double x, double y, double size, std::string_view words, const Colour& colour) {
  for (const char letter : words) {
    for_each_stroke(letter, [&](double x0, double y0, double x1, double y1) {
      add_stroke({x + size * x0, y - size * y0}, {x + size * x1, y - size * y1}, kStroke * size);
    });
    x += kAdvance * size;
  }
  paint(colour);
  return x;
}

double Canvas::text_width(double size, std::string_view words) {
  return kAdvance * size * static_cast<double>(words.size());
}

}  // namespace chicane::recording
