// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "chicane/base/result.hpp"
#include "chicane/run/parallel.hpp"
#include "chicane/run/roads.hpp"
#include "chicane/sweep/plan.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::sweep {

enum class Until { kItsEnd, kOffRoad };

/// Drives one run to its end, or to the first time that a tyre leaves the road: no sockets, no clock. Nothing
/// when `stop` has ended it before. Fails as protocol::compose() and run::ClosedLoop::create() do.
[[nodiscard]] Result<std::optional<telemetry::RunSummary>> drive(const Settings& settings, run::Roads& roads,
                                                                 const std::atomic<bool>& stop,
                                                                 Until until = Until::kItsEnd);

/// Outcome of a run of a plan.
struct RunOutcome {
  telemetry::RunSummary run;                      ///< result; of a search: the clean one, or else the slowest
  double search_value = telemetry::kNotMeasured;  ///< value of Search::key; not-a-number: none was clean
  std::uint64_t search_trials = 0;                ///< 0: nothing was searched
};

/// Looks for the largest clean value (plan.hpp); `settings` without it. Runs that leave the road end there.
/// Otherwise as drive().
[[nodiscard]] Result<std::optional<RunOutcome>> find_largest(const Search& search, const Settings& settings,
                                                             run::Roads& roads,
                                                             const std::atomic<bool>& stop);

/// The line of a run: its number, what makes it different, and its columns or the reason why it cannot be
/// driven.
[[nodiscard]] std::string line_of(const Plan& plan, std::uint64_t run, const Settings& varied,
                                  const Result<RunOutcome>& result);

struct Progress {
  std::uint64_t runs = 0;    ///< runs of the shard
  std::uint64_t found = 0;   ///< done when the sweep began
  std::uint64_t driven = 0;  ///< runs driven since
  std::uint64_t failed = 0;  ///< driven runs that failed
  std::string why{};         ///< the reason of one of those
  [[nodiscard]] bool is_complete() const noexcept { return found + driven == runs; }
};

struct SweepOptions {
  int jobs = 1;        ///< threads
  std::string file{};  ///< results of this shard; an existing file is completed
  std::function<void(const Progress&)> on_progress{};  ///< called after each run, on any thread
  /// Called for each run that could be driven, one thread at a time; includes the times of clocks, which the
  /// file leaves out.
  std::function<void(std::uint64_t run, const telemetry::RunSummary&)> on_run{};
};

/// Rule that drives one run of a plan: returns the rest of its line after number and settings, a JSON object
/// such as `{"back_s":12.5,"is_back":true}`; none when it was stopped. An error: the run cannot be driven.
/// Called by several threads, each with `roads` of its own.
using RunRule = std::function<Result<std::optional<std::string>>(std::uint64_t run, run::Roads& roads)>;

/// Drives the runs of a shard that are not in the file yet, each by `rule`. Each run depends on the plan and
/// its number alone: not on threads, shards, order or earlier runs. Ends early with partial results when
/// `stop` is set; kIo when the file cannot be written, with all runs so far in it.
[[nodiscard]] Result<Progress> drive_plan(const Plan& plan, const run::Shard& shard,
                                          const SweepOptions& options, const RunRule& rule,
                                          const std::atomic<bool>& stop);
/// The same, each run driven once or searched as the plan says.
[[nodiscard]] Result<Progress> drive_plan(const Plan& plan, const run::Shard& shard,
                                          const SweepOptions& options, const std::atomic<bool>& stop);

}  // namespace chicane::sweep
