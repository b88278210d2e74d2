// SPDX-License-Identifier: MIT
// Common parts of the commands that drive many runs: threads, progress, files of results, tables.
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

/// Begins a command that drives many runs: lets the process keep memory that a run frees, for the next run.
/// Returns the flag that Ctrl-C and SIGTERM set (program.hpp).
[[nodiscard]] std::atomic<bool>& begin_many_runs();

/// Replaces the part of a page after `marker`; without the marker the whole page. kIo.
[[nodiscard]] Result<void> write_below(const std::string& page, std::string_view marker,
                                       const std::string& text);

/// Progress of many runs on stderr: how many are done, how fast, and how long the rest will take. One thread
/// at a time.
class RunCounter {
 public:
  /// `what`: plural noun for the counted things.
  explicit RunCounter(const char* what = "runs") : what_{what} {}
  /// Shows that `done` of `runs` are done. `driven`: those since the start, for the speed.
  void show(std::uint64_t done, std::uint64_t runs, std::uint64_t driven);
  /// Ends the line of progress.
  void end() { line_.end(); }
  /// Observer for SweepOptions::on_progress, valid as long as this counter.
  [[nodiscard]] std::function<void(const sweep::Progress&)> follow();

 private:
  const char* what_;
  StatusLine line_;
};

/// Runs of a command: a plan, and the function that drives each run.
struct PlanRuns {
  sweep::Plan plan;
  sweep::RunRule rule{};      ///< empty: drives as a sweep does
  const char* what = "runs";  ///< plural noun for the counted things
  /// A run that cannot be driven becomes a line with the reason; else drive_runs() fails.
  bool keeps_failed = false;
};

/// Lines of results by number of the run; runs that were stopped are missing.
struct RunLines {
  std::map<std::uint64_t, protocol::Json> lines;
  sweep::Progress progress;
};

/// Drives the runs with `jobs` threads, 0: as many as there are processors, and shows the progress on stderr.
/// `results`: file for the lines, which is completed if it exists; empty: none. Fails as sweep::drive_plan()
/// does, and with the error of the first run that cannot be driven.
[[nodiscard]] Result<RunLines> drive_runs(const PlanRuns& runs, int jobs, const std::string& results,
                                          const std::atomic<bool>& stop);

/// Prints `{"rows": [...]}` on stdout.
void print_rows(protocol::Json rows);
/// Prints a table on stdout as the options ask for: text, Markdown, or JSON as print_rows().
void print_table(const Options& options, const sweep::ResultTable& table);

}  // namespace chicane::apps
