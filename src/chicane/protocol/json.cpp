// SPDX-License-Identifier: MIT
#include "chicane/protocol/json.hpp"

namespace chicane::protocol {

std::string json_text(const Json& json, JsonLayout layout) {
  return json.dump(layout == JsonLayout::kIndented ? 2 : -1, ' ', false, Json::error_handler_t::replace);
}

Json parse_json(std::string_view text) { return Json::parse(text, nullptr, false); }

}  // namespace chicane::protocol
