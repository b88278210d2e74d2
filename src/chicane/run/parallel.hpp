// SPDX-License-Identifier: MIT
// Parallel runs: many runs on the threads of one machine, shares of a sweep for the machines of a cluster,
// and a queue between two threads.
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

/// Calls work(i, roads) once for each i in [0, count), in rising order, on `jobs` threads including the
/// calling one. Each thread has its own `roads`. After a call that returns false no further call begins.
void for_each_run(std::uint64_t count, int jobs, const std::function<bool(std::uint64_t, Roads&)>& work);

/// Number of threads for `wanted` jobs; 0: as many as there are processors.
[[nodiscard]] int threads_for(int wanted);

/// Share of a sweep that one process drives: the runs whose number leaves the remainder `index` when divided
/// by `count`.
struct Shard {
  std::uint64_t index = 0;  ///< number of this share, from 0
  std::uint64_t count = 1;  ///< number of shares
  std::string from{};  ///< source of the share for messages: "--shard"; empty: this process drives all runs

  /// Whether this share has the run of this number.
  [[nodiscard]] bool has(std::uint64_t run) const noexcept { return run % count == index; }
  /// Number of this share's runs out of `runs`.
  [[nodiscard]] std::uint64_t size(std::uint64_t runs) const noexcept {
    return runs / count + (runs % count > index ? 1 : 0);
  }
  /// Name of this share's file: "results.3-of-7.jsonl" for "results.jsonl"; `file` itself if `from` is empty.
  [[nodiscard]] std::string file_of(const std::string& file) const;
};

/// Shard from "3/7", counted from 1. kInvalidArgument otherwise.
[[nodiscard]] Result<Shard> parse_shard(std::string_view text);

/// Shard by the environment that a launcher sets: task of a Slurm array (SLURM_ARRAY_TASK_ID), task of a
/// Slurm step (SLURM_PROCID), rank of MPI (OMPI_COMM_WORLD_RANK, PMI_RANK), or an array of such steps. All
/// runs if no launcher has set variables. `variable` gives the value of a variable, or null. kInvalidArgument
/// for contradictory numbers, and for arrays with holes.
[[nodiscard]] Result<Shard> environment_shard(const std::function<const char*(const char*)>& variable);

/// Queue from one thread to one other, in order: a ring in fixed memory. Neither thread waits. Allocates only
/// if the assignment of an Item does. Capacity: chosen for changes of settings, which come by hand.
template <class Item, std::uint64_t Capacity = 256>
class ThreadQueue {
 public:
  static constexpr std::uint64_t kCapacity = Capacity;

  /// Appends a value, on the sending thread. False, without effect, when no more than `reserve` places are
  /// free.
  template <class Value = Item>
  bool push(Value&& value, std::uint64_t reserve = 0) noexcept {
    if (room() <= reserve) return false;
    const std::uint64_t number = put_.load(std::memory_order_relaxed);
    slot(number) = std::forward<Value>(value);
    put_.store(number + 1, std::memory_order_release);
    return true;
  }
  /// Number of free places, on the sending thread.
  [[nodiscard]] std::uint64_t room() const noexcept {
    return kCapacity - (put_.load(std::memory_order_relaxed) - taken_.load(std::memory_order_acquire));
  }

  /// Oldest value, on the receiving thread; null when there is none. Valid until pop().
  [[nodiscard]] Item* front() noexcept {
    const std::uint64_t number = taken_.load(std::memory_order_relaxed);
    return number == put_.load(std::memory_order_acquire) ? nullptr : &slot(number);
  }
  /// Removes the oldest value, on the receiving thread. Pre: front() is not null.
  void pop() noexcept { taken_.fetch_add(1, std::memory_order_release); }

 private:
  [[nodiscard]] Item& slot(std::uint64_t number) {
    return slots_[static_cast<std::size_t>(number % kCapacity)];
  }

  std::vector<Item> slots_ = std::vector<Item>(kCapacity);
  std::atomic<std::uint64_t> put_{0};    ///< values appended so far
  std::atomic<std::uint64_t> taken_{0};  ///< values removed so far
};

}  // namespace chicane::run
