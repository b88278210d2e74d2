// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "chicane/base/result.hpp"
#include "chicane/net/server.hpp"
#include "options.hpp"

namespace chicane::apps {

/// Listening address and access rules from the command line, with a new token unless --no-token.
/// kInvalidArgument for --no-token on an address that other machines reach.
[[nodiscard]] Result<net::ServerOptions> server_options(const Options& options);

/// Address that a person opens: "http://localhost:4567/?token=...". The browser keeps the token as a cookie.
[[nodiscard]] std::string link(const net::ServerOptions& server, std::uint16_t port);

}  // namespace chicane::apps
