// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <mutex>

#include "chicane/net/server.hpp"
#include "net/raw_socket.hpp"
#include "support/chicane_test.hpp"

namespace chicane::test {

/// A server that remembers what happened, for a test thread that waits for it.
class Recorder {
 public:
  explicit Recorder(net::ServerOptions options = {}, std::vector<net::Asset> assets = {},
                    std::function<std::optional<net::Content>(std::string_view)> on_get = {}) {
    options.port = 0;
    net::ServerHandlers handlers{
        .on_start = {},
        .on_upgrade =
            [this](const net::UpgradeRequest& request) {
              const std::lock_guard lock(mutex_);
              upgrade_ = request;
              return answer_;
            },
        .on_open = [this](net::ConnectionId id, int) { note([&] { opened_.push_back(id); }); },
        .on_message = [this](net::ConnectionId, int, std::string_view bytes,
                             bool) { note([&] { messages_.emplace_back(bytes); }); },
        .on_close = [this](net::ConnectionId, int,
                           std::string_view why) { note([&] { closed_.emplace_back(why); }); },
        .on_get = std::move(on_get)};
    auto created = net::Server::create(options, std::move(handlers), std::move(assets));
    if (created) server_ = std::move(*created);
  }
  ~Recorder() { server_.reset(); }

  [[nodiscard]] net::Server& server() { return *server_; }
  [[nodiscard]] std::uint16_t port() const { return server_->port(); }
  void answer(net::UpgradeAnswer answer) {
    const std::lock_guard lock(mutex_);
    answer_ = std::move(answer);
  }
  net::UpgradeRequest upgrade() {
    const std::lock_guard lock(mutex_);
    return upgrade_;
  }
  std::vector<net::ConnectionId> opened(std::size_t count) { return wait(opened_, count); }
  std::vector<std::string> messages(std::size_t count) { return wait(messages_, count); }
  std::vector<std::string> closed(std::size_t count) { return wait(closed_, count); }

 private:
  template <class Change>
  void note(Change change) {
    const std::lock_guard lock(mutex_);
    change();
    changed_.notify_all();
  }
  template <class T>
  std::vector<T> wait(const std::vector<T>& list, std::size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::seconds{10}, [&] { return list.size() >= count; });
    return list;
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  net::UpgradeAnswer answer_{.accept = true};
  net::UpgradeRequest upgrade_;
  std::vector<net::ConnectionId> opened_;
  std::vector<std::string> messages_;
  std::vector<std::string> closed_;
  std::unique_ptr<net::Server> server_;
};

inline RawSocket upgraded(std::uint16_t port, int receive_buffer = 0) {
  RawSocket socket(port, receive_buffer);
  socket.send(unity_handshake(port));
  EXPECT_THAT(socket.until("\r\n\r\n"), StartsWith("HTTP/1.1 101"));
  return socket;
}

}  // namespace chicane::test
