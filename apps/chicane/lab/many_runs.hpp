// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/sweep/result_table.hpp"
#include "chicane/sweep/sweep.hpp"
#include "options.hpp"
#include "program.hpp"

namespace chicane::apps {

/// Begins a command that drives many runs. Each takes some megabytes and gives them back: the process keeps
/// them for the next one. Ctrl-C and SIGTERM set the flag that is returned (program.hpp).
[[nodiscard]] std::atomic<bool>& begin_many_runs();

/// Replaces the part of a page behind `marker`, or a whole page without one. kIo.
[[nodiscard]] Result<void> write_below(const std::string& page, std::string_view marker,
                                       const std::string& text);

/// Shows on stderr how many of many runs are done, how fast, and how long the rest will take. One thread at a
/// time.
class RunCounter {
 public:
  /// `what`: plural noun for the counted things.
  explicit RunCounter(const char* what = "runs") : what_{what} {}
  /// `driven`: of the `done` ones since the start, for the speed.
  void show(std::uint64_t done, std::uint64_t runs, std::uint64_t driven);
  /// Leaves the cursor at the beginning of a line.
  void end() { line_.end(); }
  /// Observer for SweepOptions::on_progress, valid as long as this counter.
  [[nodiscard]] std::function<void(const sweep::Progress&)> follow();

 private:
  const char* what_;
  StatusLine line_;
};

/// The runs of a command: a plan, and what drives each of them.
struct PlanRuns {
  sweep::Plan plan;
  sweep::RunRule rule{};      ///< empty: as a sweep does
  const char* what = "runs";  ///< plural noun for the counted things
  bool keeps_failed = false;  ///< a run that cannot be driven is a line with the reason, and no failure
};

/// Lines of results by number; stopped runs are missing.
struct RunLines {
  std::map<std::uint64_t, protocol::Json> lines;
  sweep::Progress progress;
};

/// Drives the runs with `jobs` threads, 0: as many as there are processors, and reports progress on stderr.
/// The lines are kept in `results`, where an older file is completed; empty: nowhere. Fails as
/// sweep::drive_plan() does, and with the first line of a run that cannot be driven.
[[nodiscard]] Result<RunLines> drive_runs(const PlanRuns& runs, int jobs, const std::string& results,
                                          const std::atomic<bool>& stop);

/// Prints `{"rows": [...]}` on stdout.
void print_rows(protocol::Json rows);
/// Prints a table on stdout in the chosen form: text, Markdown or the rows of print_rows().
void print_table(const Options& options, const sweep::ResultTable& table);

}  // namespace chicane::apps
