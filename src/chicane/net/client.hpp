// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "chicane/base/result.hpp"

namespace chicane::net {

/// WebSocket client with time-outs, blocking, for one thread: the simulator's side of the wire. Sends the same upgrade
/// request as the original (docs/protocol.md): no Origin, no sub-protocol, no extension.
class Client {
 public:
  /// url: "ws://host:port/path". kIo with the reason when it cannot connect within `timeout`.
  [[nodiscard]] static Result<std::unique_ptr<Client>> connect(const std::string& url, std::chrono::milliseconds timeout);
  virtual ~Client() = default;

  [[nodiscard]] virtual Result<void> send_text(const std::string& text) = 0;
  /// The next text message; nullopt when none came within `timeout`; kIo when the connection has ended.
  [[nodiscard]] virtual Result<std::optional<std::string>> receive(std::chrono::milliseconds timeout) = 0;
};

}  // namespace chicane::net
