// SPDX-License-Identifier: MIT
#include "chicane/net/detail/access.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <array>

namespace chicane::net {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool equal(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

/// "name:port" or "[::1]:port" without the port and the brackets; empty when the port is not a number.
std::string_view without_port(std::string_view host) {
  std::string_view name = host;
  std::string_view port;
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    if (end == std::string_view::npos) return {};
    name = host.substr(1, end - 1);
    port = host.substr(end + 1);
  } else if (const std::size_t colon = host.find(':'); colon != std::string_view::npos) {
    name = host.substr(0, colon);
    port = host.substr(colon);
  }
  if (!port.empty() && (port[0] != ':' || port.find_first_not_of("0123456789", 1) != std::string_view::npos))
    return {};
  return name;
}

bool is_numeric_address(std::string_view name) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  const std::string text(name);
  return inet_pton(AF_INET, text.c_str(), bytes.data()) == 1 ||
         inet_pton(AF_INET6, text.c_str(), bytes.data()) == 1;
}

bool is_loopback(std::string_view name) {
  return name == "::1" || (name.starts_with("127.") && is_numeric_address(name));
}

}  // namespace

bool address_is_loopback(std::string_view address) { return is_loopback(address); }

bool host_is_loopback(std::string_view host) {
  const std::string_view name = without_port(host);
  return equal(name, "localhost") || is_loopback(name);
}

bool host_is_allowed(std::string_view host, std::string_view address,
                     const std::vector<std::string>& allowed) {
  const std::string_view name = without_port(host);
  if (name.empty()) return false;
  if (equal(name, "localhost") || is_loopback(name) || name == address) return true;
  if (!is_loopback(address) && is_numeric_address(name)) return true;
  return std::any_of(allowed.begin(), allowed.end(),
                     [&](const std::string& entry) { return equal(entry, name); });
}

bool origin_is_allowed(std::string_view origin, std::string_view host,
                       const std::vector<std::string>& allowed) {
  if (std::find(allowed.begin(), allowed.end(), origin) != allowed.end()) return true;
  constexpr std::string_view kScheme = "http://";  // the only one that is served
  return origin.starts_with(kScheme) && equal(origin.substr(kScheme.size()), host);
}

}  // namespace chicane::net
