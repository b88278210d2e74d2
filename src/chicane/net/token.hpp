// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "chicane/base/result.hpp"

namespace chicane::net {

/// A secret that cannot be guessed: 192 random bits of the system's, as 32 letters, digits, '-' and '_'. kIo
/// where the system has none to give.
[[nodiscard]] Result<std::string> make_token();

/// Whether `given` is `token`, in a time that tells nothing but the length. Never for an empty token.
[[nodiscard]] bool is_token(std::string_view given, std::string_view token) noexcept;

}  // namespace chicane::net
