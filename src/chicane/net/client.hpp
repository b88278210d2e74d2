// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "chicane/base/result.hpp"

namespace chicane::net {

/// A WebSocket address in parts.
struct Url {
  std::string host;  ///< host without brackets
  std::uint16_t port = 80;
  std::string target = "/";  ///< path and query
};

/// Parts of "ws://host[:port][/path]"; kInvalidArgument in words otherwise.
[[nodiscard]] Result<Url> parse_url(const std::string& text);

/// WebSocket client with time-outs, blocking, for one thread: the simulator's side of the wire. Sends the
/// same upgrade request as the original, byte for byte (docs/reference/wire.md §1): no Origin, no
/// sub-protocol, no extension. Sends nothing before the server's 101. Answers pings. Frames are masked; a
/// message goes out as one frame.
class Client {
 public:
  /// Connects. kIo with the reason if there is no connection and upgrade within `timeout`.
  [[nodiscard]] static Result<std::unique_ptr<Client>> connect(const std::string& url,
                                                               std::chrono::milliseconds timeout);
  /// Sends a close frame when the connection stands, and does not wait for the answer.
  virtual ~Client() = default;

  [[nodiscard]] virtual Result<void> send_text(const std::string& text) = 0;
  /// The next text message; nullopt when none came within `timeout`; kIo when the connection has ended.
  [[nodiscard]] virtual Result<std::optional<std::string>> receive(std::chrono::milliseconds timeout) = 0;
};

}  // namespace chicane::net
