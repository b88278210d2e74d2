// SPDX-License-Identifier: MIT
// Runs on many threads, and the share of a process in a cluster's array of jobs.
#include "chicane/run/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <thread>

#include "chicane/base/text.hpp"

namespace chicane::run {

void for_each_run(std::uint64_t count, int jobs, const std::function<bool(std::uint64_t, Roads&)>& work) {
  std::atomic<std::uint64_t> next{0};
  std::atomic<bool> goes_on{true};
  const auto run = [&] {
    Roads roads;
    for (std::uint64_t i = next++; i < count && goes_on; i = next++)
      if (!work(i, roads)) goes_on = false;
  };
  std::vector<std::thread> others;
  for (int j = 1; j < jobs; ++j) others.emplace_back(run);
  run();
  for (std::thread& other : others) other.join();
}

int threads_for(int wanted) {
  return wanted > 0 ? wanted : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

namespace {

constexpr std::uint64_t kMostShards = 1'000'000;  // chosen: more than any cluster has processes
// Largest number in a variable; chosen: products of two fit.
constexpr std::uint64_t kMostNumber = 1'000'000'000;

using Variable = std::function<const char*(const char*)>;

/// Numbers of variables that a launcher sets together; none if the first is not set.
template <std::size_t N>
Result<std::optional<std::array<std::uint64_t, N>>> numbers_of(const Variable& variable,
                                                               const std::array<const char*, N>& names) {
  std::array<std::uint64_t, N> numbers{};
  if (variable(names[0]) == nullptr) return std::optional<std::array<std::uint64_t, N>>{};
  for (std::size_t i = 0; i < N; ++i) {
    const char* const text = variable(names[i]);
    const std::optional<std::uint64_t> number = count_in(text == nullptr ? "" : text);
    if (!number || *number > kMostNumber) {
      return fail(ErrorCode::kInvalidArgument,
                  fmt::format("{}: got {}, expected a number together with {}; --shard I/N says it", names[i],
                              printable(text == nullptr ? "" : text), names[0]));
    }
    numbers[i] = *number;
  }
  return std::optional(numbers);
}

/// Share by the task of a Slurm array; all runs outside one.
Result<Shard> array_shard(const Variable& variable) {
  const auto numbers =
      numbers_of<5>(variable, {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", "SLURM_ARRAY_TASK_MIN",
                               "SLURM_ARRAY_TASK_MAX", "SLURM_ARRAY_TASK_STEP"});
  if (!numbers) return fail(numbers.error());
  if (!*numbers) return Shard{};
  const auto [id, count, first, last, step] = **numbers;
  const bool is_even = step > 0 && last >= first && id >= first && (last - first) / step + 1 == count &&
                       (id - first) % step == 0;
  if (!is_even) {
    return fail(
        ErrorCode::kInvalidArgument,
        fmt::format("SLURM_ARRAY_TASK_ID: got {} of {} tasks from {} to {}, expected an array without "
                    "holes; --shard I/N says it",
                    id, count, first, last));
  }
  return Shard{(id - first) / step, count, "Slurm array"};
}

/// Share by the rank in MPI or a Slurm step; all runs outside one.
Result<Shard> rank_shard(const Variable& variable) {
  struct Launcher {
    const char *rank, *size, *name;
  };
  constexpr std::array kLaunchers{Launcher{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", "MPI"},
                                  Launcher{"PMI_RANK", "PMI_SIZE", "MPI"},
                                  Launcher{"SLURM_PROCID", "SLURM_STEP_NUM_TASKS", "Slurm step"}};
  for (const Launcher& each : kLaunchers) {
    // A batch script of Slurm has a SLURM_PROCID without being a task of a step.
    if (variable(each.size) == nullptr) continue;
    const auto numbers = numbers_of<2>(variable, {each.rank, each.size});
    if (!numbers) return fail(numbers.error());
    if (!*numbers) continue;
    const auto [rank, size] = **numbers;
    if (rank < size) return Shard{rank, size, each.name};
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("{}: got {}, expected less than {} ({})", each.rank, rank, size, each.size));
  }
  return Shard{};
}

}  // namespace

std::string Shard::file_of(const std::string& file) const {
  if (from.empty()) return file;
  const std::filesystem::path path(file);
  const std::string name =
      fmt::format("{}.{}-of-{}{}", path.stem().string(), index + 1, count, path.extension().string());
  return (path.parent_path() / name).string();
}

Result<Shard> parse_shard(std::string_view text) {
  const std::size_t slash = text.find('/');
  const auto index = count_in(text.substr(0, slash));
  const auto count = count_in(slash == std::string_view::npos ? "" : text.substr(slash + 1));
  if (index && count && *index >= 1 && *index <= *count && *count <= kMostShards)
    return Shard{*index - 1, *count, "--shard"};
  return fail(refusal("--shard", text, "I/N with 1 <= I <= N, like 3/7"));
}

Result<Shard> environment_shard(const Variable& variable) {
  const Result<Shard> array = array_shard(variable);
  if (!array) return array;
  const Result<Shard> rank = rank_shard(variable);
  if (!rank) return rank;
  if (array->from.empty()) return rank;
  if (rank->from.empty()) return array;
  return Shard{array->index * rank->count + rank->index, array->count * rank->count,
               fmt::format("{} of {}", rank->from, array->from)};
}

}  // namespace chicane::run
