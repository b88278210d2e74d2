// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <concepts>
#include <cstdio>
#include <string>

namespace chicane::lap_time {

/// Numbers in the text of an error: `format` has a %f, %e or %g for each of them.
[[nodiscard]] std::string message(const char* format, std::same_as<double> auto... values) {
  std::array<char, 320> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, values...);
  return buffer.data();
}

}  // namespace chicane::lap_time
