// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "chicane/base/result.hpp"

namespace chicane {

/// The shortest text that reads back as the same bits: "0.1", "1000000", "1e-05", "nan", "-inf". A point in
/// every locale.
[[nodiscard]] std::string number_text(double value);
/// Rounded to `digits` significant ones: "0.05", "66.7". A point in every locale.
[[nodiscard]] std::string number_text(double value, int digits);

/// The finite number that a whole text is: digits with a point in every locale, no blank, no plus sign.
[[nodiscard]] std::optional<double> number_in(std::string_view text) noexcept;
/// A whole number of digits alone.
[[nodiscard]] std::optional<std::uint64_t> count_in(std::string_view text) noexcept;
/// Clamped to [low, high] where it rounds to a border; else refusal(key, text, "a number in [low, high]").
[[nodiscard]] Result<double> number_in(std::string_view key, std::string_view text, double low, double high);

/// "KEY: got TEXT, expected EXPECTED", the text as printable() shows it.
[[nodiscard]] Error refusal(std::string_view key, std::string_view text, std::string_view expected,
                            ErrorCode code = ErrorCode::kInvalidArgument);

/// For messages: the first 60 bytes of foreign text without control characters; "nothing" when empty.
[[nodiscard]] std::string printable(std::string_view text);

/// RFC 4648, with padding.
[[nodiscard]] std::string base64(std::string_view bytes);

/// "udacity, road-car".
[[nodiscard]] std::string joined(std::span<const std::string_view> words);

}  // namespace chicane
