// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace chicane::net {

/// Who listens on a TCP port of this machine, as /proc tells: "mpc (pid 1234)". "a connection that is
/// just ending" when nobody does, "another program" when the process belongs to somebody else and cannot be
/// seen.
[[nodiscard]] std::string port_holder(std::uint16_t port);

}  // namespace chicane::net
