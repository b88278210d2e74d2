// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "chicane/base/result.hpp"

namespace chicane {

/// The shortest text that reads back as the same bits: "0.1", "1000000", "1e-05", "nan", "-inf". Decimal
/// point in every locale.
[[nodiscard]] std::string number_text(double value);
/// Text with `digits` significant digits: "0.05", "66.7". Decimal point in every locale.
[[nodiscard]] std::string number_text(double value, int digits);

/// The finite number that a whole text is: digits with a point in every locale, no blank, no plus sign.
[[nodiscard]] std::optional<double> number_in(std::string_view text) noexcept;
/// A whole number of digits alone.
[[nodiscard]] std::optional<std::uint64_t> count_in(std::string_view text) noexcept;
/// Number in `text`, clamped to [low, high] if it rounds to a border; else refusal(key, text, "a number in
/// [low, high]").
[[nodiscard]] Result<double> number_in(std::string_view key, std::string_view text, double low, double high);

/// Error "KEY: got TEXT, expected EXPECTED", the text as printable() shows it.
[[nodiscard]] Error refusal(std::string_view key, std::string_view text, std::string_view expected,
                            ErrorCode code = ErrorCode::kInvalidArgument);

/// Foreign text for messages: its first 60 bytes without control characters; "nothing" if it is empty.
[[nodiscard]] std::string printable(std::string_view text);

/// Base64 by RFC 4648, with padding.
[[nodiscard]] std::string base64(std::string_view bytes);

/// Words as a list: "udacity, road-car".
[[nodiscard]] std::string joined(std::span<const std::string_view> words);

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

/// Severity of a state of the program. The numbers equal ROS 2's diagnostic_msgs/DiagnosticStatus.
enum class Severity : std::uint8_t { kOk = 0, kWarning = 1, kError = 2 };

/// One value of an enumeration, as programs and as people read it.
template <class Enum>
struct Word {
  Enum value;
  std::string_view
      name;  ///< snake_case: a key of JSON; in capitals and with a prefix a constant of a message
  Severity severity;
  std::string_view sentence;  ///< subject and verb, at most 14 words, without capital and full stop, so that
                              ///< it can follow a colon
};

/// The row of a value; null for a number that is none of them.
template <class Enum>
[[nodiscard]] constexpr const Word<Enum>* find_word(std::span<const Word<Enum>> words, Enum value) noexcept {
  const auto found =
      std::find_if(words.begin(), words.end(), [&](const auto& row) { return row.value == value; });
  return found == words.end() ? nullptr : &*found;
}

}  // namespace chicane
