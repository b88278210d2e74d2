// SPDX-License-Identifier: MIT
#include "access.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <array>
#include <utility>

#include "chicane/net/http_response.hpp"

namespace chicane::apps {
namespace {

/// Address of this machine that others may reach; empty if it has none.
std::string own_address() {
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return {};
  std::string found;
  for (const ifaddrs* each = all; each != nullptr && found.empty(); each = each->ifa_next) {
    const bool is_ours = each->ifa_addr != nullptr && each->ifa_addr->sa_family == AF_INET &&
                         (each->ifa_flags & IFF_UP) != 0U && (each->ifa_flags & IFF_LOOPBACK) == 0U;
    if (!is_ours) continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    const auto* address = reinterpret_cast<const sockaddr_in*>(each->ifa_addr);
    if (::inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size()) != nullptr) found = text.data();
  }
  ::freeifaddrs(all);
  return found;
}

/// Host that a browser asks for.
std::string host_of(const std::string& address) {
  if (address == "127.0.0.1") return "localhost";
  if (address == "0.0.0.0" || address == "::") {
    const std::string own = own_address();
    return own.empty() ? "localhost" : own;
  }
  return address.find(':') == std::string::npos ? address : "[" + address + "]";
}

}  // namespace

Result<net::ServerOptions> server_options(const Options& options) {
  net::ServerOptions server;
  server.address = options.address;
  server.port = options.port;
  server.allowed_origins = options.allowed_origins;
  server.allowed_hosts = options.allowed_hosts;
  server.goodbye = std::chrono::seconds{4};  // a page on a busy machine may be behind
  if (!options.needs_token) return server;
  Result<std::string> token = net::make_token();
  if (!token) return fail(token.error());
  server.token = std::move(*token);
  return server;
}

std::string link(const net::ServerOptions& server, std::uint16_t port) {
  const std::string page = fmt::format("http://{}:{}/", host_of(server.address), port);
  return server.token.empty() ? page : page + "?token=" + server.token;
}

}  // namespace chicane::apps
