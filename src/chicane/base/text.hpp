// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace chicane {

/// The shortest text that reads back as the same bits: "0.1", "1000000", "1e-05", "nan", "-inf". A point in
/// every locale.
[[nodiscard]] std::string number_text(double value);
/// Rounded to `digits` significant ones: "0.05", "66.7". A point in every locale.
[[nodiscard]] std::string number_text(double value, int digits);

/// For messages: the first 60 bytes of foreign text without control characters; "nothing" when empty.
[[nodiscard]] std::string printable(std::string_view text);

/// "udacity, road-car".
[[nodiscard]] std::string joined(std::span<const std::string_view> words);

}  // namespace chicane
