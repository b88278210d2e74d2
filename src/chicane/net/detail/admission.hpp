// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
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

/// What a request says of its sender. Empty where a header is absent.
struct Visitor {
  std::string_view target{};  ///< path and query
  std::string_view host{};
  std::string_view origin{};
  std::string_view cookies{};
  std::size_t hosts = 1;  ///< Host headers
  bool is_upgrade = false;
};

/// What may be done with it.
struct Admission {
  unsigned status =
      200;  ///< of an answer in words, unless 200; 303: go to `location` with the token kept as a cookie
  std::string words{};       ///< of the answer
  std::string location{};    ///< same server, without the token
  bool may_watch = false;    ///< read what the run shows
  bool may_control = false;  ///< change the state of the run
};

/// Who may do what with one server, by what stands in a request's head (docs/security.md has the table).
struct Doorkeeper {
  std::string address;                       ///< that is listened on
  std::vector<std::string> allowed_hosts;    ///< beside ours
  std::vector<std::string> allowed_origins;  ///< beside our own pages
  std::string token;                         ///< empty: none is asked for
  std::uint16_t port = 0;

  [[nodiscard]] Admission admit(const Visitor& visitor) const;
  /// Value of a Set-Cookie header that carries the token.
  [[nodiscard]] std::string cookie() const;

 private:
  [[nodiscard]] std::string cookie_name() const;
  [[nodiscard]] bool is_own(std::string_view origin, std::string_view host) const;
};

}  // namespace chicane::net
