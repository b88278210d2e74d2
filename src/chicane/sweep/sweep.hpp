// SPDX-License-Identifier: MIT
// Drives the runs of a plan in parallel, once each or with a search for the largest clean value, and writes a
// line of results for each run.
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

/// End of a run: its own, or the first time that a tyre leaves the road.
enum class Until { kItsEnd, kOffRoad };

/// Drives one run without sockets or clocks. Empty if `stop` ended it early. Fails as protocol::compose() and
/// run::ClosedLoop::create() do.
[[nodiscard]] Result<std::optional<telemetry::RunSummary>> drive(const Settings& settings, run::Roads& roads,
                                                                 const std::atomic<bool>& stop,
                                                                 Until until = Until::kItsEnd);

/// Outcome of one run of a plan.
struct RunOutcome {
  telemetry::RunSummary run;  ///< summary; of a search: of the largest clean value, else of the smallest one
  double search_value = telemetry::kNotMeasured;  ///< largest clean value of Search::key; NaN: none was clean
  std::uint64_t search_trials = 0;                ///< number of runs driven by a search; 0: no search
};

/// Searches for the largest clean value (Search in plan.hpp); `settings`: those of the run, without the
/// searched key. Runs that leave the road end there, but for the smallest value. Stops and fails as drive().
[[nodiscard]] Result<std::optional<RunOutcome>> find_largest(const Search& search, const Settings& settings,
                                                             run::Roads& roads,
                                                             const std::atomic<bool>& stop);

/// Line of a run in the file of results: its number, the settings `varied` in which it differs, and its
/// columns or the error.
[[nodiscard]] std::string line_of(const Plan& plan, std::uint64_t run, const Settings& varied,
                                  const Result<RunOutcome>& result);

/// Progress of a sweep, in runs.
struct Progress {
  std::uint64_t runs = 0;    ///< runs of the shard
  std::uint64_t found = 0;   ///< runs in the file when the sweep began
  std::uint64_t driven = 0;  ///< runs driven since then
  std::uint64_t failed = 0;  ///< driven runs that failed
  std::string why{};         ///< error of the first failed run
  [[nodiscard]] bool is_complete() const noexcept { return found + driven == runs; }
};

/// Options of drive_plan().
struct SweepOptions {
  int jobs = 1;        ///< number of threads
  std::string file{};  ///< results of this shard; an existing file is completed
  std::function<void(const Progress&)> on_progress{};  ///< called after each run, on any thread
  /// Called for each driven run, by one thread at a time. The summary includes clock times, which the file
  /// leaves out.
  std::function<void(std::uint64_t run, const telemetry::RunSummary&)> on_run{};
};

/// Function that drives one run of a plan. Returns the results for its line as a JSON object, such as
/// `{"back_s":12.5,"is_back":true}`; empty if it was stopped; an error if the run cannot be driven. Called by
/// several threads, each with its own `roads`.
using RunRule = std::function<Result<std::optional<std::string>>(std::uint64_t run, run::Roads& roads)>;

/// Drives the runs of a shard that are not in the file yet, each by `rule`. A run depends on the plan and its
/// number alone: not on threads, shards, order or earlier runs. Ends early when `stop` is set. kIo if the
/// file cannot be written. In both cases the file has all runs that are done.
[[nodiscard]] Result<Progress> drive_plan(const Plan& plan, const run::Shard& shard,
                                          const SweepOptions& options, const RunRule& rule,
                                          const std::atomic<bool>& stop);
/// Drives the runs of a shard once each, or with the plan's search; otherwise as the function above.
[[nodiscard]] Result<Progress> drive_plan(const Plan& plan, const run::Shard& shard,
                                          const SweepOptions& options, const std::atomic<bool>& stop);

}  // namespace chicane::sweep
