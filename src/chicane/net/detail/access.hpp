// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace chicane::net {

/// Is a Host header (with or without port) one of ours? `localhost` and loopback addresses always; the bound
/// `address`; any numeric address when bound to more than loopback (a rebinding attack needs a name); names
/// in `allowed`, which are compared whole and without regard to case.
[[nodiscard]] bool host_is_allowed(std::string_view host, std::string_view address,
                                   const std::vector<std::string>& allowed);

/// Does an Origin header name the same host and port as the Host header, by HTTP without TLS as this server
/// speaks it, or stand in `allowed` word for word?
[[nodiscard]] bool origin_is_allowed(std::string_view origin, std::string_view host,
                                     const std::vector<std::string>& allowed);

/// Is a numeric address one of this machine alone?
[[nodiscard]] bool address_is_loopback(std::string_view address);
/// Does a Host header (with or without port) name this machine: `localhost` or a loopback address?
[[nodiscard]] bool host_is_loopback(std::string_view host);

}  // namespace chicane::net
