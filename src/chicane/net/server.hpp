// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/net/http_response.hpp"

namespace chicane::net {

class Server;

/// One connection of one server, never reused.
using ConnectionId = std::uint64_t;

/// An HTTP upgrade as it arrived; bounded sizes are already checked.
struct UpgradeRequest {
  ConnectionId id = 0;   ///< number of the connection if it is accepted
  std::string target{};  ///< path and query, e.g. "/socket.io/?EIO=4&transport=websocket"
  std::string peer{};    ///< "127.0.0.1:51234"
  std::string origin{};  ///< empty when absent
  std::string host{};
  std::vector<std::string> subprotocols{};  ///< subprotocols as offered, in order
  bool may_watch = false;                   ///< may read: frames, settings, files
  bool may_control = false;                 ///< may change settings and call services
  bool is_crowded = false;                  ///< no connection is free for viewers, only for others
};

/// Answer to an upgrade. The server itself refuses a Host that is not ours (see
/// ServerOptions::allowed_hosts), an Origin that is neither Host nor allowed, a wrong token, and a connection
/// too many. The endpoint refuses what may_watch and may_control forbid (docs/reference/security.md).
struct UpgradeAnswer {
  bool accept = false;
  std::string subprotocol{};  ///< one of the offered ones, or empty
  int status = 403;           ///< HTTP status when refused
  std::string reason{};       ///< one sentence, sent as the body when refused
  int endpoint = 0;           ///< caller's own tag, handed back with every event
};

/// Limits and rules. Against web pages that talk to local programs: the Host header must be `localhost`, a
/// loopback address, the bound address, any IP address when bound to more than loopback, or in
/// `allowed_hosts`; an Origin header, where present (browsers always send it), must name the same host and
/// port or be in `allowed_origins`.
struct ServerOptions {
  std::string address = "127.0.0.1";  ///< numeric; "::" listens on every IPv6 and IPv4 address
  std::uint16_t port = 4567;          ///< 0 = any free port (see Server::port)
  std::size_t max_message = 65536;    ///< larger messages close the connection with 1009 [byte]
  std::size_t max_header = 8192;      ///< limit of an HTTP request's head; larger ones get 431 [byte]
  /// Connections beyond get 503. When all are taken, a new one replaces the oldest without an upgrade. The
  /// last eighth, at most 8, is not for WebSocket viewers.
  std::size_t max_connections = 1024;
  /// Time for a whole HTTP request, and between two on one connection.
  std::chrono::milliseconds handshake_timeout{5000};
  /// A WebSocket peer that has sent nothing for half of it is pinged; one that stays silent for all of it is
  /// closed. That also ends peers that stopped reading, because they never see the ping.
  std::chrono::milliseconds idle_timeout{10000};
  /// Time that a server that ends leaves its peers to read what waits and to answer the close frame. What a
  /// peer has not read by then is lost.
  std::chrono::milliseconds goodbye{200};
  std::size_t max_queue = 256;  ///< messages waiting for one connection before it is closed
  /// Bytes waiting for all connections together; beyond, connections that hold more than others are closed
  /// when they are sent more.
  std::size_t max_waiting = 64UL << 20U;
  std::vector<std::string> allowed_hosts{};    ///< further names without port, e.g. "car.local"
  std::vector<std::string> allowed_origins{};  ///< pages beside our own, e.g. "https://app.foxglove.dev"
  /// Token of visitors who change something, or who see something on an address that other machines reach
  /// (http_response.hpp, docs/reference/security.md); empty: none is needed.
  std::string token{};
};

/// Called on the network thread, one at a time. They must not block. None is called once ~Server has begun.
struct ServerHandlers {
  std::function<void(Server&)> on_start{};  ///< called before the first connection; may be empty
  std::function<UpgradeAnswer(const UpgradeRequest&)> on_upgrade{};
  std::function<void(ConnectionId, int endpoint)> on_open{};
  std::function<void(ConnectionId, int endpoint, std::string_view bytes, bool binary)> on_message{};
  std::function<void(ConnectionId, int endpoint, std::string_view why)> on_close{};
  /// Answer to a GET or HEAD of `path` (no query); none: the asset of that name, or 404. Compare whole paths
  /// with the few you offer, and never make a file's name of one. May be empty.
  std::function<std::optional<Content>(std::string_view path)> on_get{};
  /// Sentence for a GET of `target` (path and query) that should have asked for an upgrade, with the remedy;
  /// empty: an upgrade is not needed. May be empty.
  std::function<std::string(std::string_view target)> on_no_upgrade{};
  /// A request of `peer` was refused at the door, in these words. May be empty.
  std::function<void(std::string_view peer, std::string_view words)> on_refused{};
};

/// Queueing of a message for a slow reader.
enum class Delivery {
  kReliable,  ///< queued in order; a connection whose queue is full is closed
  kNewest,    ///< replaces a waiting message of the same `topic`: slow clients lose frames, we lose nothing
};

/// A message, shared: one frame for many viewers is stored once.
using Bytes = std::shared_ptr<const std::string>;

/// HTTP and WebSocket server on one port and one network thread of its own. It knows bytes, no message and no
/// car. `on_get` and assets answer GET and HEAD, the former by range too; everything that asks for an
/// upgrade, on any path, goes to `on_upgrade`. No extension is ever negotiated. All member functions may be
/// called from any thread, and never wait for the network.
class Server {
 public:
  /// Binds and starts. kIo if the port is taken, with the sentence that helps ("port 4567 is in use by ...").
  [[nodiscard]] static Result<std::unique_ptr<Server>> create(const ServerOptions& options,
                                                              ServerHandlers handlers,
                                                              std::vector<Asset> assets);
  virtual ~Server() = default;  ///< closes all connections and joins the thread

  [[nodiscard]] virtual std::uint16_t port() const noexcept = 0;
  /// Sends a message; nothing if the connection has ended meanwhile.
  virtual void send(ConnectionId to, Bytes bytes, bool binary, Delivery delivery = Delivery::kReliable,
                    std::uint32_t topic = 0) = 0;
  void send(ConnectionId to, std::string bytes, bool binary, Delivery delivery = Delivery::kReliable,
            std::uint32_t topic = 0) {
    send(to, std::make_shared<const std::string>(std::move(bytes)), binary, delivery, topic);
  }
  /// Number of messages sent to a connection that the system has not taken yet. Network thread only.
  [[nodiscard]] virtual std::size_t waiting(ConnectionId id) const = 0;
  /// Sends what waits, then a close frame with `code` (RFC 6455 §7.4); on_close follows.
  virtual void close(ConnectionId id, std::uint16_t code, std::string_view reason) = 0;
  /// Runs `task` on the network thread after `delay` (0 = as soon as possible).
  virtual void run_after(std::chrono::nanoseconds delay, std::function<void()> task) = 0;
};

}  // namespace chicane::net
