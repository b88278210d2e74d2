// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <string_view>

#include "chicane/net/server.hpp"

namespace chicane::live {

/// A server without a network, for a run inside of the page that shows it: one connection, whose messages are
/// handed to a function, and a clock that its owner moves. Like one with a network it holds back what the
/// page has not taken yet, of frames the newest only. One thread.
class WorkerServer final : public net::Server {
 public:
  using Send = std::function<void(std::string_view bytes, bool binary)>;
  static constexpr net::ConnectionId kPage = 1;
  static constexpr std::size_t kInFlight = 64;  ///< messages that the page may have before it

  WorkerServer(net::ServerHandlers handlers, Send send);

  /// The page connects; anew when it was connected before. False when it is refused.
  bool connect();
  void receive(std::string_view bytes, bool binary);
  /// The page has taken `count` messages more.
  void acknowledge(std::size_t count);
  [[nodiscard]] std::optional<net::Content> get(std::string_view path) const {
    return handlers_.on_get(path);
  }
  /// The clock shows `now` [s], from any beginning: does what is due.
  void pass_time(double now);

  using net::Server::send;
  [[nodiscard]] std::uint16_t port() const noexcept override { return 0; }
  void send(net::ConnectionId to, net::Bytes bytes, bool binary, net::Delivery delivery,
            std::uint32_t topic) override;
  [[nodiscard]] std::size_t waiting(net::ConnectionId id) const override;
  void close(net::ConnectionId id, std::uint16_t code, std::string_view reason) override;
  void run_after(std::chrono::nanoseconds delay, std::function<void()> task) override;

 private:
  struct Held {
    net::Bytes bytes;
    bool binary = false;
    net::Delivery delivery = net::Delivery::kReliable;
    std::uint32_t topic = 0;
  };
  void flush();

  net::ServerHandlers handlers_;
  Send send_;
  bool is_open_ = false;
  int endpoint_ = 0;
  std::deque<Held> held_;
  std::size_t in_flight_ = 0;
  double now_ = 0.0;                                    ///< [s]
  std::multimap<double, std::function<void()>> tasks_;  ///< by when they are due [s]
};

}  // namespace chicane::live
