// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace chicane::run {

/// Values from one thread to one other, in order. Neither waits; no allocation beside what copying an Item
/// takes.
template <class Item>
class ThreadQueue {
 public:
  static constexpr std::uint64_t kCapacity = 256;

  /// The sending thread. False, and nothing happens, when the queue is full.
  bool push(const Item& item) noexcept {
    const std::uint64_t number = put_.load(std::memory_order_relaxed);
    if (number - taken_.load(std::memory_order_acquire) >= kCapacity) return false;
    slots_[static_cast<std::size_t>(number % kCapacity)] = item;
    put_.store(number + 1, std::memory_order_release);
    return true;
  }
  /// The sending thread: what still fits.
  [[nodiscard]] std::uint64_t room() const noexcept {
    return kCapacity - (put_.load(std::memory_order_relaxed) - taken_.load(std::memory_order_acquire));
  }

  /// The receiving thread: the oldest one, nullptr when there is none. Valid until pop().
  [[nodiscard]] const Item* front() const noexcept {
    const std::uint64_t number = taken_.load(std::memory_order_relaxed);
    if (number == put_.load(std::memory_order_acquire)) return nullptr;
    return &slots_[static_cast<std::size_t>(number % kCapacity)];
  }
  /// The receiving thread. Pre: front() is not null.
  void pop() noexcept { taken_.fetch_add(1, std::memory_order_release); }

 private:
  std::array<Item, kCapacity> slots_{};
  std::atomic<std::uint64_t> put_{0};
  std::atomic<std::uint64_t> taken_{0};
};

}  // namespace chicane::run
