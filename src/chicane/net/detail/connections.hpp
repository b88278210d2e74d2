// SPDX-License-Identifier: MIT
// Access rules of a server, and the queue of messages that wait for each connection.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/net/server.hpp"

namespace chicane::net {

/// Head of a request, as far as access depends on it. A text is empty where its header is absent.
struct Visitor {
  std::string_view target{};   ///< path and query
  std::string_view host{};     ///< Host header
  std::string_view origin{};   ///< Origin header: scheme, host and port of the page that sends the request
  std::string_view cookies{};  ///< Cookie header
  std::size_t hosts = 1;       ///< number of Host headers
  bool is_upgrade = false;     ///< asks for a WebSocket
};

/// Decision about a request.
struct Admission {
  /// 200: admitted. 303: redirect to `location`, with the token as a cookie. 400 and 403: refused with
  /// `words`.
  unsigned status = 200;
  std::string words{};       ///< text of a refusal
  std::string location{};    ///< target on this server, without the token
  bool may_watch = false;    ///< may read the run
  bool may_control = false;  ///< may change the run
};

/// Access rules of one server, applied to a request's head (docs/reference/security.md has the table).
struct Doorkeeper {
  std::string address;                       ///< listening address
  std::vector<std::string> allowed_hosts;    ///< hosts allowed in addition to ours
  std::vector<std::string> allowed_origins;  ///< origins allowed in addition to our own pages
  std::string token;                         ///< secret of visitors; empty: none is needed
  std::uint16_t port = 0;                    ///< listening port

  [[nodiscard]] Admission admit(const Visitor& visitor) const;
  /// Value of a Set-Cookie header that carries the token.
  [[nodiscard]] std::string cookie() const;

 private:
  [[nodiscard]] std::string cookie_name() const;
};

/// Error of a server that cannot listen: names the program that has the port if the port `is_in_use`, else
/// the system's reason in `words`.
[[nodiscard]] Error cannot_listen(const std::string& address, std::uint16_t port, bool is_in_use,
                                  const std::string& words);

/// A message to a connection.
struct Outgoing {
  Bytes bytes;
  bool binary = false;  ///< frame type: binary or text
  Delivery delivery = Delivery::kReliable;
  std::uint32_t topic = 0;  ///< number by which Delivery::kNewest finds the message to replace
};

/// Sum of the bytes that wait for all connections. Bytes shared by several messages count once.
class WaitingBytes {
 public:
  void add(const Bytes& bytes) {
    if (++holders_[bytes.get()] == 1) total_ += bytes->size();
  }
  void remove(const Bytes& bytes) {
    const auto holder = holders_.find(bytes.get());
    if (--holder->second > 0) return;
    total_ -= bytes->size();
    holders_.erase(holder);
  }
  [[nodiscard]] std::size_t total() const { return total_; }

 private:
  std::unordered_map<const std::string*, std::size_t> holders_;  ///< number of messages with these bytes
  std::size_t total_ = 0;                                        ///< [byte]
};

/// Messages that wait for one connection. While the connection writes (`is_writing`), the front message is
/// the one being written, which is neither replaced nor dropped.
class SendQueue {
 public:
  explicit SendQueue(WaitingBytes& all) : all_{all} {}
  SendQueue(const SendQueue&) = delete;
  SendQueue& operator=(const SendQueue&) = delete;
  ~SendQueue() { drop_waiting(false); }

  /// Adds a message. False if `most` messages wait already.
  [[nodiscard]] bool add(Outgoing message, bool is_writing, std::size_t most) {
    if (message.delivery == Delivery::kNewest) {
      const auto waiting =
          std::find_if(waiting_.begin() + (is_writing ? 1 : 0), waiting_.end(), [&](const Outgoing& other) {
            return other.delivery == Delivery::kNewest && other.topic == message.topic;
          });
      if (waiting != waiting_.end()) {
        charge(message);
        release(*waiting);
        *waiting = std::move(message);
        return true;
      }
    }
    if (waiting_.size() >= most) return false;
    charge(message);
    waiting_.push_back(std::move(message));
    return true;
  }
  [[nodiscard]] const Outgoing& front() const { return waiting_.front(); }
  void pop() {
    release(waiting_.front());
    waiting_.pop_front();
  }
  /// Drops all messages that are not being written.
  void drop_waiting(bool is_writing) {
    while (waiting_.size() > (is_writing ? 1U : 0U)) {
      release(waiting_.back());
      waiting_.pop_back();
    }
  }
  [[nodiscard]] bool empty() const { return waiting_.empty(); }
  [[nodiscard]] std::size_t size() const { return waiting_.size(); }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  void charge(const Outgoing& message) {
    bytes_ += message.bytes->size();
    all_.add(message.bytes);
  }
  void release(const Outgoing& message) {
    bytes_ -= message.bytes->size();
    all_.remove(message.bytes);
  }

  std::deque<Outgoing> waiting_;  ///< oldest first
  WaitingBytes& all_;             ///< sum over all connections
  std::size_t bytes_ = 0;         ///< bytes in this connection's queue
};

}  // namespace chicane::net
