// SPDX-License-Identifier: MIT
#include "chicane/base/text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace chicane {
namespace {

std::string written(double value, auto... format) {
  std::array<char, 64> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format...).ptr;
  return {buffer.data(), end};
}

}  // namespace

std::string number_text(double value) {
  const double size = std::fabs(value);
  const bool is_plain = size == 0.0 || !std::isfinite(value) || (size >= 1e-4 && size < 1e16);
  return written(value, is_plain ? std::chars_format::fixed : std::chars_format::scientific);
}

std::string number_text(double value, int digits) {
  return written(value, std::chars_format::general, digits);
}

std::string printable(std::string_view text) {
  constexpr std::size_t kMost = 60;
  std::string shown(text.substr(0, kMost));
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, '?');
  return shown.empty() ? "nothing" : text.size() > kMost ? shown + "…" : shown;
}

std::string joined(std::span<const std::string_view> words) {
  std::string text;
  for (const std::string_view word : words) text.append(text.empty() ? "" : ", ").append(word);
  return text;
}

}  // namespace chicane
