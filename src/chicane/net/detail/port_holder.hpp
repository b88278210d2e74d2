// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "chicane/base/result.hpp"

namespace chicane::net {

/// Who listens on a TCP port of this machine, as /proc tells: "mpc (pid 1234)". "a connection that is
/// just ending" when nobody does, "another program" when the process belongs to somebody else and cannot be
/// seen.
[[nodiscard]] std::string port_holder(std::uint16_t port);

/// Why nothing can be listened on at `address` and `port`: `is_in_use`, or in the system's `words`.
[[nodiscard]] Error cannot_listen(const std::string& address, std::uint16_t port, bool is_in_use,
                                  const std::string& words);

}  // namespace chicane::net
