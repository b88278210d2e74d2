// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/run/roads.hpp"

namespace chicane::run {

/// Calls work(i, roads) once for each i in [0, count), on `jobs` threads, this one among them; i rises, and
/// no two calls share a `roads`. A work that returns false ends it all: those that have begun are finished.
void for_each_run(std::uint64_t count, int jobs, const std::function<bool(std::uint64_t, Roads&)>& work);

/// Threads for `wanted` jobs; 0: as many as there are processors.
[[nodiscard]] int threads_for(int wanted);

/// The part of a sweep that one process drives: the runs whose index leaves the remainder `index` when
/// divided by `count`.
struct Shard {
  std::uint64_t index = 0;
  std::uint64_t count = 1;
  std::string from{};  ///< source for messages: "--shard"; empty: everything is ours

  [[nodiscard]] bool has(std::uint64_t run) const noexcept { return run % count == index; }
  /// Number of this shard's runs out of `runs`.
  [[nodiscard]] std::uint64_t size(std::uint64_t runs) const noexcept {
    return runs / count + (runs % count > index ? 1 : 0);
  }
  /// File of this shard: "results.3-of-7.jsonl" for "results.jsonl"; the name itself if everything is ours.
  [[nodiscard]] std::string file_of(const std::string& file) const;
};

/// Shard from "3/7", counted from 1. kInvalidArgument otherwise.
[[nodiscard]] Result<Shard> parse_shard(std::string_view text);

/// Shard by the environment of this process's launcher: the place in a Slurm array (SLURM_ARRAY_TASK_ID),
/// among the tasks of a Slurm step (SLURM_PROCID) or the ranks of MPI (OMPI_COMM_WORLD_RANK, PMI_RANK), an
/// array of such steps included. Everything without such variables. `variable` gives a variable's value, or
/// null. kInvalidArgument for numbers that make no sense, and for arrays with holes.
[[nodiscard]] Result<Shard> environment_shard(const std::function<const char*(const char*)>& variable);

/// Values from one thread to one other, in order: a ring in fixed memory. Neither waits; allocates
/// only where assigning an Item does.
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
