// SPDX-License-Identifier: MIT
// Access rules for requests, and the program that has a port which cannot be listened on.
#include "chicane/net/detail/connections.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>

#include "chicane/base/text.hpp"
#include "chicane/net/http_response.hpp"

namespace chicane::net {
namespace {

/// Whether two texts are equal but for the case of ASCII letters.
bool equal(std::string_view a, std::string_view b) { return lower(a) == lower(b); }

bool is_among(const std::vector<std::string>& entries, std::string_view text) {
  return std::find(entries.begin(), entries.end(), text) != entries.end();
}

/// Host of "name:port" or "[::1]:port", without port and brackets; empty if the port is no number.
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

/// Whether a numeric address is one of this machine alone.
bool is_loopback(std::string_view name) {
  return name == "::1" || (name.starts_with("127.") && is_numeric_address(name));
}

Admission refuse(unsigned status, std::string words) { return {.status = status, .words = std::move(words)}; }

/// Value of `name` in a list of "name=value" parts with `separator`s between; none when absent.
std::optional<std::string_view> value_of(std::string_view parts, char separator, std::string_view name) {
  while (!parts.empty()) {
    const std::size_t end = std::min(parts.find(separator), parts.size());
    std::string_view part = parts.substr(0, end);
    parts.remove_prefix(std::min(parts.size(), end + 1));
    while (part.starts_with(' ')) part.remove_prefix(1);
    if (part.starts_with(name) && part.substr(name.size()).starts_with('='))
      return part.substr(name.size() + 1);
  }
  return std::nullopt;
}

/// `path` as the target of a redirect; "/" for one that browsers read as another server, like "//host".
std::string page_of(std::string_view path) {
  return path.starts_with('/') && !path.starts_with("//") && path.find('\\') == std::string_view::npos
             ? std::string(path)
             : "/";
}

/// Whether a Host header (with or without port) names this machine: `localhost` or a loopback address.
bool host_is_loopback(std::string_view host) {
  const std::string_view name = without_port(host);
  return equal(name, "localhost") || is_loopback(name);
}

/// Whether a Host header (with or without port) names this server: `localhost` and loopback addresses always;
/// the bound `address`; any numeric address when bound to more than loopback (a rebinding attack needs a
/// name); names in `allowed`, compared whole and without regard to case.
bool host_is_allowed(std::string_view host, std::string_view address,
                     const std::vector<std::string>& allowed) {
  const std::string_view name = without_port(host);
  if (name.empty()) return false;
  if (host_is_loopback(host) || name == address) return true;
  if (!is_loopback(address) && is_numeric_address(name)) return true;
  return std::any_of(allowed.begin(), allowed.end(),
                     [&](const std::string& entry) { return equal(entry, name); });
}

/// Whether an Origin header names the host and port of the Host header, by HTTP: no server here speaks TLS.
bool is_own_origin(std::string_view origin, std::string_view host) {
  constexpr std::string_view kScheme = "http://";
  return origin.starts_with(kScheme) && equal(origin.substr(kScheme.size()), host);
}

}  // namespace

Admission Doorkeeper::admit(const Visitor& visitor) const {
  if (visitor.hosts != 1) return refuse(400, "one Host header is needed");
  if (!host_is_allowed(visitor.host, address, allowed_hosts))
    return refuse(
        403,
        fmt::format("host '{}' is not allowed here: use a numeric address, or start with --allow-host {}",
                    visitor.host, visitor.host.substr(0, visitor.host.find(':'))));
  const bool is_foreign = !visitor.origin.empty() && !is_own_origin(visitor.origin, visitor.host);
  const bool is_let_in = is_among(allowed_origins, visitor.origin);
  if (visitor.is_upgrade && is_foreign && !is_let_in)
    return refuse(403, fmt::format("pages of '{0}' may not connect here: start with --allow-origin {0}",
                                   visitor.origin));

  const std::size_t question = std::min(visitor.target.find('?'), visitor.target.size());
  const std::string_view path = visitor.target.substr(0, question);
  const auto in_link =
      value_of(visitor.target.substr(std::min(question + 1, visitor.target.size())), '&', "token");
  const bool has_link = in_link && is_token(*in_link, token);
  if (in_link && !token.empty() && !has_link)
    return refuse(403, "the token is not the one that the program printed");
  const auto in_cookie = value_of(visitor.cookies, ';', cookie_name());
  const bool has_token = token.empty() || has_link || (in_cookie && is_token(*in_cookie, token));

  Admission admission;
  const bool is_local = is_loopback(address) && host_is_loopback(visitor.host);
  // Origin is set by browsers alone; a page of this server was loaded from this machine.
  const bool is_local_page = is_local && !visitor.origin.empty() && !is_foreign;
  admission.may_watch = is_local || has_token;
  admission.may_control = has_token || is_local_page;
  if (!visitor.is_upgrade && !admission.may_watch)
    return refuse(403, "open the link that the program printed: it has the token that is needed here");
  if (!visitor.is_upgrade && is_foreign && !is_let_in)
    return refuse(403, "pages of other servers may not read this");
  if (has_link && !visitor.is_upgrade && path.find('.', path.rfind('/') + 1) == std::string_view::npos) {
    admission.status = 303;
    admission.location = page_of(path);
  }
  return admission;
}

// Has the port in the name: browsers keep cookies by host, so that programs on one machine need different
// names.
std::string Doorkeeper::cookie_name() const { return fmt::format("chicane-{}", port); }

std::string Doorkeeper::cookie() const {
  return fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict", cookie_name(), token);
}

namespace {

/// Adds the sockets that listen on `port`, as "socket:[INODE]", from a table of proc(5) with the columns sl,
/// local_address (hex address:port), rem_address, st (0A = listening), queues, timer, retransmits, uid,
/// timeout, inode.
void add_listeners(const char* table, std::uint16_t port, std::set<std::string>& inodes) {
  std::ifstream file(table);
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream columns(line);
    std::string slot, local, remote, state, queues, timer, retransmits, uid, timeout, inode;
    columns >> slot >> local >> remote >> state >> queues >> timer >> retransmits >> uid >> timeout >> inode;
    const std::size_t colon = local.rfind(':');
    if (state != "0A" || colon == std::string::npos) continue;
    unsigned found = 0;
    std::from_chars(local.data() + colon + 1, local.data() + local.size(), found, 16);
    if (found == port) inodes.insert("socket:[" + inode + "]");
  }
}

/// Whether a process, by its folder in /proc, has one of the sockets open.
bool holds(const std::filesystem::path& process, const std::set<std::string>& inodes) {
  std::error_code ec;
  for (std::filesystem::directory_iterator it(process / "fd", ec), end; !ec && it != end; it.increment(ec)) {
    std::error_code unreadable;
    const std::filesystem::path target = std::filesystem::read_symlink(it->path(), unreadable);
    if (!unreadable && inodes.contains(target.string())) return true;
  }
  return false;
}

/// Program that has a TCP port of this machine, from /proc: "mpc (pid 1234)". "a connection that is just
/// ending" if no program listens there, "another program" if it belongs to another user.
std::string port_holder(std::uint16_t port) {
  std::set<std::string> inodes;
  add_listeners("/proc/net/tcp", port, inodes);
  add_listeners("/proc/net/tcp6", port, inodes);
  if (inodes.empty()) return "a connection that is just ending";
  std::error_code ec;
  for (std::filesystem::directory_iterator it("/proc", ec), end; !ec && it != end; it.increment(ec)) {
    const std::string pid = it->path().filename().string();
    const bool is_process = std::all_of(pid.begin(), pid.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (!is_process || !holds(it->path(), inodes)) continue;
    std::string name;
    std::getline(std::ifstream(it->path() / "comm"), name);
    return fmt::format("{} (pid {})", name, pid);
  }
  return "another program";
}

}  // namespace

Error cannot_listen(const std::string& address, std::uint16_t port, bool is_in_use,
                    const std::string& words) {
  if (is_in_use) return {ErrorCode::kIo, fmt::format("port {} is in use by {}", port, port_holder(port))};
  return {ErrorCode::kIo, fmt::format("cannot listen on {}:{}: {}", address, port, words)};
}

}  // namespace chicane::net
