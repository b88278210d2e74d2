// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

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

}  // namespace chicane::survey
