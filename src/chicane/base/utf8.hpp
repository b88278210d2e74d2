// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace chicane {

/// Length of the UTF-8 sequence at the beginning of `text`; 0 when it is none (RFC 3629: no overlong forms,
/// no surrogates). `text` is not empty.
[[nodiscard]] constexpr std::size_t utf8_length(std::string_view text) noexcept {
  const auto byte = [&](std::size_t i) -> std::uint32_t {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const auto continues = [&](std::size_t i) { return (byte(i) & 0xc0U) == 0x80U; };
  if (byte(0) < 0x80U) return 1;
  if (byte(0) >= 0xc2U && byte(0) < 0xe0U) return continues(1) ? 2 : 0;
  const std::uint32_t first_two = byte(0) << 8U | byte(1);
  if ((byte(0) & 0xf0U) == 0xe0U) {
    const bool is_allowed = first_two >= 0xe0a0U && (first_two < 0xeda0U || first_two > 0xedbfU);
    return is_allowed && continues(1) && continues(2) ? 3 : 0;
  }
  const bool is_allowed = first_two >= 0xf090U && first_two <= 0xf48fU;
  return is_allowed && continues(1) && continues(2) && continues(3) ? 4 : 0;
}

/// Whether all of `text` is UTF-8.
[[nodiscard]] constexpr bool is_utf8(std::string_view text) noexcept {
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

}  // namespace chicane
