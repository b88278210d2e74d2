// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

#include "chicane/wire/endpoint.hpp"

namespace chicane::wire {

/// The controller program that we started ourselves, by a shell, in a process group of its own with a guard
/// at its head. The group ends with this object, and also where our process dies without a word: the guard
/// sees to that.
class ServerProcess {
 public:
  ServerProcess(std::string command, SparseLog& log) : command_{std::move(command)}, log_{log} {}
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;
  /// Asks all of the group to end, and makes them after a second.
  ~ServerProcess();

  [[nodiscard]] std::uint64_t starts() const { return starts_; }

  /// Starts it, at first and after its death, but at most once a second. Always by the same thread, which
  /// lives as long as this: the guard watches that one. Nothing happens for an empty command.
  void keep_running(std::chrono::steady_clock::time_point now);

 private:
  void start();

  std::string command_;
  SparseLog& log_;
  int pid_ = -1;  ///< the guard's, and the group's
  std::uint64_t starts_ = 0;
  std::chrono::steady_clock::time_point started_{};
};

}  // namespace chicane::wire
