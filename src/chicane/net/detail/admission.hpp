// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace chicane::net {

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
