// SPDX-License-Identifier: MIT
// Reads grey images from PGM and PNG files; computes the distance field and the connected regions of a mask.
#include "chicane/survey/image.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "chicane/base/text.hpp"

namespace chicane::survey {
namespace {

/// Fails unless an image has a cell and no more than kMostCells.
Result<void> check_size(double width, double height, const std::string& file) {
  const bool is_sound =
      width >= 1.0 && height >= 1.0 && width * height <= static_cast<double>(GreyImage::kMostCells);
  if (is_sound) return {};
  return fail(ErrorCode::kParse, fmt::format("{}: size: got {} x {}, expected 1 to {} cells", file, width,
                                             height, GreyImage::kMostCells));
}

/// Takes the next word of a PGM header off `rest`; a comment reaches from # to the end of the line.
std::string_view next_word(std::string_view& rest) {
  const auto is_space = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
  while (!rest.empty() && (is_space(rest.front()) || rest.front() == '#')) {
    const std::size_t end = rest.front() == '#' ? rest.find('\n') : 0;
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  std::size_t size = 0;
  while (size < rest.size() && !is_space(rest[size])) ++size;
  const std::string_view word = rest.substr(0, size);
  rest.remove_prefix(size);
  return word;
}

/// Image in a PGM file, as text (P2) or one byte for each cell (P5).
Result<GreyImage> read_pgm(std::string_view bytes, const std::string& file) {
  const bool is_text = bytes.starts_with("P2");
  std::string_view rest = bytes.substr(2);
  const double width = number_in(next_word(rest)).value_or(0.0);
  const double height = number_in(next_word(rest)).value_or(0.0);
  if (const Result<void> sound = check_size(width, height, file); !sound) return fail(sound.error());
  const std::string_view most_text = next_word(rest);
  const double most = number_in(most_text).value_or(0.0);
  if (!(most >= 1.0 && most <= 255.0))
    return fail(ErrorCode::kParse,
                fmt::format("{}: largest grey value: got {}, expected 1 to 255", file, printable(most_text)));
  GreyImage image{.width = static_cast<int>(width), .height = static_cast<int>(height)};
  const auto cells = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (!is_text && !rest.empty()) rest.remove_prefix(1);  // the one space behind the header
  image.values.reserve(std::min(cells, rest.size()));
  for (std::size_t i = 0; i < cells; ++i) {
    const std::optional<double> value = is_text ? number_in(next_word(rest))
                                        : i < rest.size()
                                            ? std::optional<double>(static_cast<unsigned char>(rest[i]))
                                            : std::nullopt;
    if (!value || *value < 0.0 || *value > most)
      return fail(ErrorCode::kParse,
                  fmt::format("{}: grey value {} of {}: got {}, expected 0 to {:.0f}", file, i + 1, cells,
                              value ? fmt::format("{}", *value) : "none", most));
    image.values += static_cast<char>(static_cast<unsigned char>(std::lround(*value * 255.0 / most)));
  }
  return image;
}

/// Image in a PNG file, made grey by libpng.
Result<GreyImage> read_png(std::string_view bytes, const std::string& file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0)
    return fail(ErrorCode::kParse, fmt::format("{}: got a PNG that cannot be read: {}", file, png.message));
  if (const Result<void> sound = check_size(png.width, png.height, file); !sound) {
    png_image_free(&png);
    return fail(sound.error());
  }
  png.format = PNG_FORMAT_GRAY;
  GreyImage image{.width = static_cast<int>(png.width), .height = static_cast<int>(png.height)};
  image.values.resize(PNG_IMAGE_SIZE(png));
  const png_color white{255, 255, 255};
  if (png_image_finish_read(&png, &white, image.values.data(), 0, nullptr) == 0)
    return fail(ErrorCode::kParse, fmt::format("{}: got a PNG that cannot be read: {}", file, png.message));
  return image;
}

}  // namespace

Result<GreyImage> read_image(std::string_view bytes, const std::string& file) {
  if (bytes.starts_with("P2") || bytes.starts_with("P5")) return read_pgm(bytes, file);
  if (bytes.starts_with("\x89PNG")) return read_png(bytes, file);
  return fail(ErrorCode::kParse,
              fmt::format("{}: got other bytes, expected a PGM (P2, P5) or PNG image", file));
}

namespace {

constexpr float kNoneInColumn = 1e6F;  // [cells] distance in a column without a set cell: beyond all images
constexpr double kFar = 1e12;          // [cells²] its square

/// Squared distances of the cells of one row from the distances within their columns: the lower envelope of
/// the parabolas (x − q)² + from[q], one for each cell q of the row.
class Envelope {
 public:
  explicit Envelope(std::size_t most) : from_(most), to_(most), vertex_(most), bound_(most + 1) {}

  /// Squared distances within the columns, to be set [cells²].
  std::vector<double>& from() { return from_; }
  /// Squared distances of the first `count` cells of the row [cells²].
  const std::vector<double>& measure(std::size_t count) {
    // The parabolas that are part of the envelope, from left to right.
    std::size_t top = 0;
    vertex_[0] = 0;
    bound_[0] = -kFar;
    bound_[1] = kFar;
    for (std::size_t q = 1; q < count; ++q) {
      double meets = crossing(q, vertex_[top]);
      while (top > 0 && meets <= bound_[top]) meets = crossing(q, vertex_[--top]);
      if (meets <= bound_[top]) {
        vertex_[top] = q;
        continue;
      }
      vertex_[++top] = q;
      bound_[top] = meets;
      bound_[top + 1] = kFar;
    }
    // The value of the envelope at each cell.
    std::size_t at = 0;
    for (std::size_t q = 0; q < count; ++q) {
      while (bound_[at + 1] < static_cast<double>(q)) ++at;
      const double away = static_cast<double>(q) - static_cast<double>(vertex_[at]);
      to_[q] = std::min(kFar, away * away + from_[vertex_[at]]);
    }
    return to_;
  }

 private:
  /// Place in the row at which the parabolas of the cells q and v have the same value.
  [[nodiscard]] double crossing(std::size_t q, std::size_t v) const {
    const double a = static_cast<double>(q), b = static_cast<double>(v);
    return ((from_[q] + a * a) - (from_[v] + b * b)) / (2.0 * (a - b));
  }

  std::vector<double> from_, to_;    ///< from() and the result of measure() [cells²]
  std::vector<std::size_t> vertex_;  ///< cells whose parabolas are part of the envelope
  std::vector<double> bound_;        ///< limits between these parts; kFar beyond the last
};

}  // namespace

std::vector<float> distance_field(const std::vector<std::uint8_t>& is_set, int width, int height) {
  const auto columns = static_cast<std::size_t>(width);
  const auto rows = static_cast<std::size_t>(height);
  std::vector<float> field(columns * rows);
  // Distances within each column: a sweep downwards, then one upwards.
  for (std::size_t x = 0; x < columns; ++x) {
    float away = kNoneInColumn;
    for (std::size_t y = 0; y < rows; ++y) {
      away = is_set[y * columns + x] != 0 ? 0.0F : std::min(away + 1.0F, kNoneInColumn);
      field[y * columns + x] = away;
    }
    for (std::size_t y = rows; y-- > 0;) {
      away = std::min(away + 1.0F, field[y * columns + x]);
      field[y * columns + x] = away;
    }
  }
  Envelope envelope(columns);
  for (std::size_t y = 0; y < rows; ++y) {
    float* const row = field.data() + y * columns;
    for (std::size_t x = 0; x < columns; ++x)
      envelope.from()[x] = static_cast<double>(row[x]) * static_cast<double>(row[x]);
    const std::vector<double>& squares = envelope.measure(columns);
    for (std::size_t x = 0; x < columns; ++x) row[x] = static_cast<float>(std::sqrt(squares[x]));
  }
  return field;
}

std::vector<Region> regions_of(const Mask& mask, const Grid& grid, int neighbours, std::vector<int>& labels) {
  std::vector<Region> regions;
  labels.assign(grid.size(), 0);
  std::vector<std::size_t> open;
  for (std::size_t seed = 0; seed < grid.size(); ++seed) {
    if (mask[seed] == 0 || labels[seed] != 0) continue;
    const Place begin = grid.place(seed);
    Region region{.left = begin.x, .right = begin.x, .low = begin.y, .high = begin.y, .rightmost = seed};
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
      grid.for_each_neighbour(index, neighbours, [&](int /*n*/, std::size_t next) {
        if (mask[next] == 0 || labels[next] != 0) return;
        labels[next] = label;
        open.push_back(next);
      });
    }
    regions.push_back(region);
  }
  return regions;
}

}  // namespace chicane::survey
