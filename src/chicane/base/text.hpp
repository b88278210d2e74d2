// SPDX-License-Identifier: MIT
// Texts: numbers to text and back in every locale, names of enumerations, quoting of foreign text in
// messages.
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

/// Shortest text that reads back as the same bits: "0.1", "1000000", "1e-05", "nan", "-inf". Decimal point in
/// every locale.
[[nodiscard]] std::string number_text(double value);
/// Text with at most `digits` significant digits, without zeros at the end: "0.05", "66.7". Decimal point in
/// every locale.
[[nodiscard]] std::string number_text(double value, int digits);

/// Finite number written by the whole text, with a decimal point in every locale; none for a text with blanks
/// or a plus sign.
[[nodiscard]] std::optional<double> number_in(std::string_view text) noexcept;
/// Whole number written by the whole text in digits alone.
[[nodiscard]] std::optional<std::uint64_t> count_in(std::string_view text) noexcept;
/// Number written by `text`, in [low, high]. A number outside by at most 1e-6 · max(1, |limit|), the rounding
/// of single precision, is set to the limit. Any other text fails with refusal(key, text, "a number in [low,
/// high]").
[[nodiscard]] Result<double> number_in(std::string_view key, std::string_view text, double low, double high);

/// Error "KEY: got TEXT, expected EXPECTED", the text as printable() shows it.
[[nodiscard]] Error refusal(std::string_view key, std::string_view text, std::string_view expected,
                            ErrorCode code = ErrorCode::kInvalidArgument);

/// Foreign text for messages: its first 60 bytes, with '?' for each control character and "…" after a cut
/// text; "nothing" if it is empty.
[[nodiscard]] std::string printable(std::string_view text);

/// Base64 by RFC 4648, with padding.
[[nodiscard]] std::string base64(std::string_view bytes);

/// Words as a list: "udacity, road-car".
[[nodiscard]] std::string joined(std::span<const std::string_view> words);

/// ASCII letters in lower case; other bytes as they are.
[[nodiscard]] std::string lower(std::string_view text);

/// Length [byte] of the UTF-8 character at the beginning of `text`; 0 if there is none (RFC 3629: no overlong
/// forms, no surrogates). Pre: `text` is not empty.
[[nodiscard]] constexpr std::size_t utf8_length(std::string_view text) noexcept {
  const auto byte = [&](std::size_t i) -> std::uint32_t {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const auto continues = [&](std::size_t i) { return (byte(i) & 0xc0U) == 0x80U; };
  if (byte(0) < 0x80U) return 1;
  if (byte(0) >= 0xc2U && byte(0) < 0xe0U) return continues(1) ? 2 : 0;
  const std::uint32_t first_two = byte(0) << 8U | byte(1);
  if ((byte(0) & 0xf0U) == 0xe0U) {
    // Below: overlong forms; between: surrogates.
    const bool is_allowed = first_two >= 0xe0a0U && (first_two < 0xeda0U || first_two > 0xedbfU);
    return is_allowed && continues(1) && continues(2) ? 3 : 0;
  }
  // Below: overlong forms; above: beyond U+10FFFF.
  const bool is_allowed = first_two >= 0xf090U && first_two <= 0xf48fU;
  return is_allowed && continues(1) && continues(2) && continues(3) ? 4 : 0;
}

/// Severity of a state of the program. The numbers equal ROS 2's diagnostic_msgs/DiagnosticStatus.
enum class Severity : std::uint8_t { kOk = 0, kWarning = 1, kError = 2 };

/// Texts of one value of an enumeration, for programs and for people.
template <class Enum>
struct Word {
  Enum value;
  /// Name in JSON, in snake_case. The constant of a ROS message is this name in capitals after a prefix.
  std::string_view name;
  Severity severity;
  /// Subject and verb, at most 14 words, without capital and full stop: can follow a colon.
  std::string_view sentence;
};

/// Row of a value; null for a number that is no value of the enumeration.
template <class Enum>
[[nodiscard]] constexpr const Word<Enum>* find_word(std::span<const Word<Enum>> words, Enum value) noexcept {
  const auto found =
      std::find_if(words.begin(), words.end(), [&](const auto& row) { return row.value == value; });
  return found == words.end() ? nullptr : &*found;
}

}  // namespace chicane
