// SPDX-License-Identifier: MIT
// WebSocket client with time-outs.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "chicane/base/result.hpp"

namespace chicane::net {

/// Parts of a WebSocket address.
struct Url {
  std::string host;  ///< host without brackets
  std::uint16_t port = 80;
  std::string target = "/";  ///< path and query
};

/// Parses "ws://host[:port][/path]". Fails with kInvalidArgument and a sentence for other texts.
[[nodiscard]] Result<Url> parse_url(const std::string& text);

/// WebSocket client, blocking, for one thread: the simulator's side of its connection to a controller. Its
/// upgrade request has the bytes of the original simulator's (docs/reference/wire.md §1): no Origin, no
/// sub-protocol, no extension. Sends nothing before the server's answer 101. Answers pings. Frames are
/// masked; a message goes out as one frame.
class Client {
 public:
  /// Connects and upgrades. Fails with kIo and the reason if that takes longer than `timeout`.
  [[nodiscard]] static Result<std::unique_ptr<Client>> connect(const std::string& url,
                                                               std::chrono::milliseconds timeout);
  /// Sends a close frame if the connection is open, and does not wait for the answer.
  virtual ~Client() = default;

  /// Sends a text message. Fails with kIo when the connection has ended or the server does not read.
  [[nodiscard]] virtual Result<void> send_text(const std::string& text) = 0;
  /// Next message; nullopt when none came within `timeout`. Fails with kIo when the connection has ended.
  [[nodiscard]] virtual Result<std::optional<std::string>> receive(std::chrono::milliseconds timeout) = 0;
};

}  // namespace chicane::net
