// SPDX-License-Identifier: MIT
#include "chicane/net/detail/port_holder.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include <fmt/format.h>

namespace chicane::net {
namespace {

/// Socket inodes that listen on `port`, from one of the tables of proc(5): columns sl, local_address (hex
/// address:port), rem_address, st (0A = listening), queues, timer, retransmits, uid, timeout, inode.
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

bool holds(const std::filesystem::path& process, const std::set<std::string>& inodes) {
  std::error_code ec;
  for (std::filesystem::directory_iterator it(process / "fd", ec), end; !ec && it != end; it.increment(ec)) {
    std::error_code unreadable;
    const std::filesystem::path target = std::filesystem::read_symlink(it->path(), unreadable);
    if (!unreadable && inodes.contains(target.string())) return true;
  }
  return false;
}

}  // namespace

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

Error cannot_listen(const std::string& address, std::uint16_t port, bool is_in_use,
                    const std::string& words) {
  if (is_in_use) return {ErrorCode::kIo, fmt::format("port {} is in use by {}", port, port_holder(port))};
  return {ErrorCode::kIo, fmt::format("cannot listen on {}:{}: {}", address, port, words)};
}

}  // namespace chicane::net
