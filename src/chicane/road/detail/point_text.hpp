// SPDX-License-Identifier: MIT
// Numbers and points as texts of messages.
#pragma once

#include <array>
#include <charconv>
#include <string>

#include "chicane/base/vec2.hpp"

namespace chicane::road {

/// Number in the shortest form that reads back the same, with a decimal point in every locale. Large round
/// numbers have an exponent ("1e+07"), unlike those of base/text.hpp.
inline std::string number_text(double value) {
  std::array<char, 32> text{};
  const std::to_chars_result end = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

/// Point as text: "(1.5, -2)".
inline std::string point_text(const Vec2& point) {
  std::string text{"("};
  return text.append(number_text(point.x())).append(", ").append(number_text(point.y())).append(")");
}

}  // namespace chicane::road
