// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <unordered_map>
#include <utility>

#include "chicane/net/server.hpp"

namespace chicane::net {

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

/// What waits for one connection, the front one being written while `is_writing`.
class SendQueue {
 public:
  explicit SendQueue(WaitingBytes& all) : all_{all} {}
  SendQueue(const SendQueue&) = delete;
  SendQueue& operator=(const SendQueue&) = delete;
  ~SendQueue() { drop_waiting(false); }

  /// False when `most` wait already.
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
  std::size_t bytes_ = 0;  ///< of this connection's own
};

}  // namespace chicane::net
