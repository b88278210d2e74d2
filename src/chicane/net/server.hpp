// SPDX-License-Identifier: MIT
// HTTP and WebSocket server: options, handlers of its events, and sending of messages.
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

/// Number of a connection of one server, never reused.
using ConnectionId = std::uint64_t;

/// Request for a WebSocket, after the server's own checks of its size and its headers.
struct UpgradeRequest {
  ConnectionId id = 0;                      ///< number of the connection if it is accepted
  std::string target{};                     ///< path and query, e.g. "/socket.io/?EIO=4&transport=websocket"
  std::string peer{};                       ///< "127.0.0.1:51234"
  std::string origin{};                     ///< Origin header; empty when absent
  std::string host{};                       ///< Host header
  std::vector<std::string> subprotocols{};  ///< subprotocols as offered, in order
  bool may_watch = false;                   ///< may read: frames, settings, files
  bool may_control = false;                 ///< may change settings and call services
  bool is_crowded = false;                  ///< the connections left are not for viewers (max_connections)
};

/// Answer of the program to an upgrade. Before it is asked, the server refuses a wrong Host or Origin (see
/// ServerOptions), a wrong token, and more than max_connections. The program refuses what may_watch and
/// may_control forbid (docs/reference/security.md).
struct UpgradeAnswer {
  bool accept = false;
  std::string subprotocol{};  ///< one of the offered ones, or empty
  int status = 403;           ///< HTTP status when refused
  std::string reason{};       ///< one sentence, sent as the body when refused
  int endpoint = 0;           ///< number of the program's own choice, an argument of every later event
};

/// Limits and rules of a server. Two rules protect local programs from web pages of others. The Host header
/// must be `localhost`, a loopback address, the bound address, any IP address when bound to more than
/// loopback, or in `allowed_hosts`. An Origin header, which browsers always send, must name the same host and
/// port or be in `allowed_origins`.
struct ServerOptions {
  std::string address = "127.0.0.1";  ///< numeric; "::" listens on every IPv6 and IPv4 address
  std::uint16_t port = 4567;          ///< port of Udacity's simulator; 0 = any free port (see Server::port)
  std::size_t max_message = 65536;    ///< larger messages close the connection with 1009 [byte]
  std::size_t max_header = 8192;      ///< limit of an HTTP request's head; larger ones get 431 [byte]
  /// Limit of open connections. When all are taken, a new one replaces the one that has been silent longest
  /// among those without an upgrade; without two of them it gets 503. WebSocket viewers leave an eighth of
  /// the connections, at most 8, to others (UpgradeRequest::is_crowded).
  std::size_t max_connections = 1024;
  /// Time for a whole HTTP request, and between two requests on one connection.
  std::chrono::milliseconds handshake_timeout{5000};
  /// Time of silence after which a WebSocket peer is closed; it is pinged after half of that time. A peer
  /// that has stopped reading is closed, too, as it never sees the ping.
  std::chrono::milliseconds idle_timeout{10000};
  /// Time that a server, when it ends, gives its peers to read waiting messages and to answer the close
  /// frame. Messages that a peer has not read by then are lost.
  std::chrono::milliseconds goodbye{200};
  std::size_t max_queue = 256;  ///< messages waiting for one connection before it is closed
  /// Bytes waiting for all connections together. Beyond this sum, a message to a connection with at least the
  /// mean number of waiting bytes closes that connection.
  std::size_t max_waiting = 64UL << 20U;
  std::vector<std::string> allowed_hosts{};    ///< further names without port, e.g. "car.local"
  std::vector<std::string> allowed_origins{};  ///< pages beside our own, e.g. "https://app.foxglove.dev"
  /// Token that visitors need to change the run, and to see it on an address that other machines reach
  /// (docs/reference/security.md). Empty: none is needed.
  std::string token{};
};

/// Handlers of events. The network thread calls them one at a time; they must not block. None is called once
/// ~Server has begun.
struct ServerHandlers {
  std::function<void(Server&)> on_start{};  ///< called before the first connection; may be empty
  std::function<UpgradeAnswer(const UpgradeRequest&)> on_upgrade{};
  std::function<void(ConnectionId, int endpoint)> on_open{};
  std::function<void(ConnectionId, int endpoint, std::string_view bytes, bool binary)> on_message{};
  std::function<void(ConnectionId, int endpoint, std::string_view why)> on_close{};
  /// Answer to a GET or HEAD of `path` (no query); none: the asset of that name, or 404. Compares whole paths
  /// with the few that it offers, and never makes a file's name of one. May be empty.
  std::function<std::optional<Content>(std::string_view path)> on_get{};
  /// Sentence with the remedy for a GET of a `target` (path and query) that is for upgrades alone; an empty
  /// sentence: `target` needs no upgrade. May be empty.
  std::function<std::string(std::string_view target)> on_no_upgrade{};
  /// Called after the access rules refused a request of `peer` with `words`. May be empty.
  std::function<void(std::string_view peer, std::string_view words)> on_refused{};
};

/// Queueing of a message for a slow reader.
enum class Delivery {
  kReliable,  ///< queued in order; a connection whose queue is full is closed
  kNewest,    ///< replaces a waiting message of the same `topic`: slow clients lose older messages
};

/// Bytes of a message, shared: a message to many viewers is stored once.
using Bytes = std::shared_ptr<const std::string>;

/// HTTP and WebSocket server on one port and one network thread of its own. It knows bytes, no message and no
/// car. `on_get` answers GET and HEAD, also by range; assets answer what `on_get` leaves. Every request for
/// an upgrade, on any path, goes to `on_upgrade`. No extension is ever negotiated. All member functions may
/// be called from any thread, unless they say otherwise, and never wait for the network.
class Server {
 public:
  /// Binds and starts. Fails with kIo if the port is taken ("port 4567 is in use by ...").
  [[nodiscard]] static Result<std::unique_ptr<Server>> create(const ServerOptions& options,
                                                              ServerHandlers handlers,
                                                              std::vector<Asset> assets);
  virtual ~Server() = default;  ///< closes all connections and joins the thread

  [[nodiscard]] virtual std::uint16_t port() const noexcept = 0;
  /// Sends a message; does nothing if the connection has ended meanwhile.
  virtual void send(ConnectionId to, Bytes bytes, bool binary, Delivery delivery = Delivery::kReliable,
                    std::uint32_t topic = 0) = 0;
  void send(ConnectionId to, std::string bytes, bool binary, Delivery delivery = Delivery::kReliable,
            std::uint32_t topic = 0) {
    send(to, std::make_shared<const std::string>(std::move(bytes)), binary, delivery, topic);
  }
  /// Number of messages sent to a connection that the system has not taken yet. Network thread only.
  [[nodiscard]] virtual std::size_t waiting(ConnectionId id) const = 0;
  /// Sends waiting messages, then a close frame with `code` (RFC 6455 §7.4); on_close follows.
  virtual void close(ConnectionId id, std::uint16_t code, std::string_view reason) = 0;
  /// Runs `task` on the network thread after `delay` (0 = as soon as possible).
  virtual void run_after(std::chrono::nanoseconds delay, std::function<void()> task) = 0;
};

}  // namespace chicane::net
