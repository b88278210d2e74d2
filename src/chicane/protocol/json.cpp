// SPDX-License-Identifier: MIT
#include "chicane/protocol/json.hpp"

namespace chicane::protocol {

std::string json_text(const Json& json, JsonLayout layout) {
  return json.dump(layout == JsonLayout::kIndented ? 2 : -1, ' ', layout == JsonLayout::kAscii,
                   Json::error_handler_t::replace);
}

Json parse_json(std::string_view text) { return Json::parse(text, nullptr, false); }

tl::expected<Json, JsonError> read_json(std::string_view text) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    return tl::unexpected(JsonError{error.byte});
  } catch (const Json::exception&) {
    return tl::unexpected(JsonError{});
  }
}

}  // namespace chicane::protocol
