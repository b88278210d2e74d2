// SPDX-License-Identifier: MIT
#include "chicane/controller/option_range.hpp"

#include <array>
#include <charconv>
#include <string>

namespace chicane::controller {
namespace {

std::string text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

}  // namespace

Result<void> check_ranges(std::initializer_list<OptionRange> ranges) {
  for (const OptionRange& range : ranges) {
    if (range.value >= range.low && range.value <= range.high) continue;
    return fail(ErrorCode::kInvalidArgument, std::string{range.name} + ": got " + text(range.value) +
                                                 ", expected " + text(range.low) + " to " + text(range.high));
  }
  return {};
}

}  // namespace chicane::controller
