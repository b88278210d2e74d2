// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

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

}  // namespace chicane::run
