// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace chicane::run {

/// Values from one thread to one other, in order: a ring in fixed memory. Neither waits; no allocation beside
/// what assigning an Item takes.
template <class Item, std::uint64_t Capacity = 256>
class ThreadQueue {
 public:
  static constexpr std::uint64_t kCapacity = Capacity;

  /// The sending thread. False, and nothing happens, when no more than `reserve` places are free.
  template <class Value = Item>
  bool push(Value&& value, std::uint64_t reserve = 0) noexcept {
    if (room() <= reserve) return false;
    const std::uint64_t number = put_.load(std::memory_order_relaxed);
    slot(number) = std::forward<Value>(value);
    put_.store(number + 1, std::memory_order_release);
    return true;
  }
  /// The sending thread: what still fits.
  [[nodiscard]] std::uint64_t room() const noexcept {
    return kCapacity - (put_.load(std::memory_order_relaxed) - taken_.load(std::memory_order_acquire));
  }

  /// The receiving thread: the oldest one, nullptr when there is none. Valid until pop().
  [[nodiscard]] Item* front() noexcept {
    const std::uint64_t number = taken_.load(std::memory_order_relaxed);
    return number == put_.load(std::memory_order_acquire) ? nullptr : &slot(number);
  }
  /// The receiving thread. Pre: front() is not null.
  void pop() noexcept { taken_.fetch_add(1, std::memory_order_release); }

 private:
  [[nodiscard]] Item& slot(std::uint64_t number) {
    return slots_[static_cast<std::size_t>(number % kCapacity)];
  }

  std::vector<Item> slots_ = std::vector<Item>(kCapacity);
  std::atomic<std::uint64_t> put_{0};
  std::atomic<std::uint64_t> taken_{0};
};

}  // namespace chicane::run
