// SPDX-License-Identifier: MIT
#include "chicane/protocol/guard_facts.hpp"

#include <algorithm>
#include <string_view>

namespace chicane::protocol {
namespace {

std::string text_of(std::string_view name, const safety::GuardOptions& guard) {
  const auto rows = safety::guard_options();
  const auto row =
      std::find_if(rows.begin(), rows.end(), [&](const Option& each) { return each.name == name; });
  return std::get<std::string>(get(*row, &guard));
}

}  // namespace

GuardFacts guard_facts(const safety::GuardOptions& guard) {
  return {.mode = text_of("mode", guard), .road = text_of("road", guard), .version = safety::kGuardVersion};
}

}  // namespace chicane::protocol
