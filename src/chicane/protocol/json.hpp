// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace chicane::protocol {

/// A JSON value; keys keep the order in which they were written. This header is for our own sources and not
/// installed. The library's reader and writer take the compiler long: they are instantiated in json.cpp
/// alone.
using Json = nlohmann::ordered_json;

enum class JsonLayout {
  kLine,      ///< on one line, without a line break at its end
  kAscii,     ///< the same with \u escapes in the place of what is not ASCII
  kIndented,  ///< by two spaces, without a line break at its end
};

/// UTF-8 text of `json`; bytes that are no UTF-8 become U+FFFD. A number that is not finite becomes null.
[[nodiscard]] std::string json_text(const Json& json, JsonLayout layout = JsonLayout::kLine);

/// The value of `text`; is_discarded() where it is no JSON. Deep nesting takes memory, not stack.
[[nodiscard]] Json parse_json(std::string_view text);

struct JsonError {
  std::optional<std::size_t>
      byte;  ///< where the text is no JSON, counted from 1; nothing when a number is too large
};

/// The same for those who say where the text is wrong.
[[nodiscard]] tl::expected<Json, JsonError> read_json(std::string_view text);

}  // namespace chicane::protocol
