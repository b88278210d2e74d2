// SPDX-License-Identifier: MIT
#include "chicane/survey/image.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "chicane/base/text.hpp"

namespace chicane::survey {
namespace {

Result<void> check_size(double width, double height, const std::string& file) {
  const bool is_sound =
      width >= 1.0 && height >= 1.0 && width * height <= static_cast<double>(GreyImage::kMostCells);
  if (is_sound) return {};
  return fail(ErrorCode::kParse, fmt::format("{}: size: got {} x {}, expected 1 to {} cells", file, width,
                                             height, GreyImage::kMostCells));
}

/// The next word of a PGM header; comments go from # to the end of the line.
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

}  // namespace chicane::survey
