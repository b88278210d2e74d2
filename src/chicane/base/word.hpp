// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>

namespace chicane {

/// How serious a state of the program is. The numbers are those of ROS 2's diagnostic_msgs/DiagnosticStatus.
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
