// SPDX-License-Identifier: MIT
// Hand-over of the newest value between two threads that never wait for each other.
#pragma once

#include <array>
#include <atomic>
#include <type_traits>

namespace chicane {

/// Newest value from one writing thread to one reading thread; neither ever waits and older values are lost.
/// A triple buffer: the writer owns one slot, the reader one, and the third, the middle, is swapped
/// atomically. T is copied; no allocation as long as copying T does not allocate.
template <class T>
class Latest {
 public:
  /// Makes `value` the newest. Writer only.
  void put(const T& value) noexcept(std::is_nothrow_copy_assignable_v<T>) {
    slots_[back_] = value;
    back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndex;
  }
  /// Replaces `value` by the newest if that was not taken before, and says whether. Reader only.
  bool take(T& value) noexcept(std::is_nothrow_copy_assignable_v<T>) {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0U) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    value = slots_[front_];
    return true;
  }

 private:
  static constexpr unsigned kFresh = 4;  ///< bit of middle_: its slot holds a value that was not taken
  static constexpr unsigned kIndex = 3;  ///< bits of middle_ that are the index of its slot
  std::array<T, 3> slots_{};
  unsigned back_ = 0;                ///< index of the writer's slot
  unsigned front_ = 2;               ///< index of the reader's slot
  std::atomic<unsigned> middle_{1};  ///< index of the third slot, and kFresh
};

}  // namespace chicane
