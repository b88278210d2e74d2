// SPDX-License-Identifier: MIT
#pragma once

#include <source_location>
#include <stdexcept>
#include <string>

namespace chicane::test {

/// A result or pointer that a test cannot go on without: ends the test where there is none, with place and
/// reason.
template <class T>
T good(T result, std::source_location at = std::source_location::current()) {
  if (result) return result;
  std::string why = std::string(at.file_name()) + ":" + std::to_string(at.line()) + ": ";
  if constexpr (requires { result.error().message; }) why += result.error().message;
  throw std::runtime_error(why);
}

/// What a refused result says; empty when it was not refused.
template <class T>
std::string refusal_of(const T& result) {
  return result ? "" : result.error().message;
}

}  // namespace chicane::test
