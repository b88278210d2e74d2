// SPDX-License-Identifier: MIT
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

/// Is a Host header (with or without port) one of ours? `localhost` and loopback addresses always; the bound
/// `address`; any numeric address when bound to more than loopback (a rebinding attack needs a name); names
/// in `allowed`, which are compared whole and without regard to case.
[[nodiscard]] bool host_is_allowed(std::string_view host, std::string_view address,
                                   const std::vector<std::string>& allowed);

/// Whether an Origin header names the same host and port as the Host header, by HTTP without TLS as this
/// server speaks it, or is in `allowed` word for word.
[[nodiscard]] bool origin_is_allowed(std::string_view origin, std::string_view host,
                                     const std::vector<std::string>& allowed);

/// Is a numeric address one of this machine alone?
[[nodiscard]] bool address_is_loopback(std::string_view address);
/// Does a Host header (with or without port) name this machine: `localhost` or a loopback address?
[[nodiscard]] bool host_is_loopback(std::string_view host);

/// Sender of a request, by its headers. Empty where a header is absent.
struct Visitor {
  std::string_view target{};  ///< path and query
  std::string_view host{};
  std::string_view origin{};
  std::string_view cookies{};
  std::size_t hosts = 1;  ///< Host headers
  bool is_upgrade = false;
};

/// Decision about a request.
struct Admission {
  unsigned status = 200;   ///< status of an answer in words, unless 200; 303: go to `location` with the token
                           ///< kept as a cookie
  std::string words{};     ///< text of the answer
  std::string location{};  ///< same server, without the token
  bool may_watch = false;  ///< reads the run
  bool may_control = false;  ///< change the state of the run
};

/// Access rules of one server, applied to a request's head (docs/reference/security.md has the table).
struct Doorkeeper {
  std::string address;                       ///< listening address
  std::vector<std::string> allowed_hosts;    ///< hosts allowed in addition to ours
  std::vector<std::string> allowed_origins;  ///< origins allowed in addition to our own pages
  std::string token;                         ///< empty: none is asked for
  std::uint16_t port = 0;

  [[nodiscard]] Admission admit(const Visitor& visitor) const;
  /// Value of a Set-Cookie header that carries the token.
  [[nodiscard]] std::string cookie() const;

 private:
  [[nodiscard]] std::string cookie_name() const;
  [[nodiscard]] bool is_own(std::string_view origin, std::string_view host) const;
};

/// Owner of a TCP port of this machine, from /proc: "mpc (pid 1234)". "a connection that is just ending"
/// without an owner, "another program" if the process belongs to another user.
[[nodiscard]] std::string port_holder(std::uint16_t port);

/// Why nothing can be listened on at `address` and `port`: `is_in_use`, or in the system's `words`.
[[nodiscard]] Error cannot_listen(const std::string& address, std::uint16_t port, bool is_in_use,
                                  const std::string& words);

struct Outgoing {
  Bytes bytes;
  bool binary = false;
  Delivery delivery = Delivery::kReliable;
  std::uint32_t topic = 0;
};

/// The bytes that wait for all connections together; what several wait for counts once.
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
  std::unordered_map<const std::string*, std::size_t> holders_;
  std::size_t total_ = 0;
};

/// Messages that wait for one connection; the front one is written while `is_writing`.
class SendQueue {
 public:
  explicit SendQueue(WaitingBytes& all) : all_{all} {}
  SendQueue(const SendQueue&) = delete;
  SendQueue& operator=(const SendQueue&) = delete;
  ~SendQueue() { drop_waiting(false); }

  /// Adds a message. False if `most` wait already.
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
  /// Drops what waits, but for the front one where it is being written.
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

  std::deque<Outgoing> waiting_;
  WaitingBytes& all_;
  std::size_t bytes_ = 0;  ///< bytes in this connection's queue
};

}  // namespace chicane::net
