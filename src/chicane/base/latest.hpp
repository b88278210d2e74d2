// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <type_traits>

namespace chicane {

/// Newest value from one writing thread to one reading thread; neither ever waits and the newest value wins.
/// A triple buffer: the writer owns one slot, the reader one, the third is swapped atomically.
/// T is copied; no allocation as long as copying T does not allocate.
template <class T>
class Latest {
 public:
  /// Writer only.
  void put(const T& value) noexcept(std::is_nothrow_copy_assignable_v<T>) {
    slots_[back_] = value;
    back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndex;
  }
  /// Reader only. True when `value` was replaced by one not seen before.
  bool take(T& value) noexcept(std::is_nothrow_copy_assignable_v<T>) {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0U) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    value = slots_[front_];
    return true;
  }

 private:
  static constexpr unsigned kFresh = 4;
  static constexpr unsigned kIndex = 3;
  std::array<T, 3> slots_{};
  unsigned back_ = 0;
  unsigned front_ = 2;
  std::atomic<unsigned> middle_{1};
};

}  // namespace chicane
