// SPDX-License-Identifier: MIT
// Common parts of the commands that drive many runs: threads, progress with the time left, and tables of
// results.
#include "lab/many_runs.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <utility>

#include "chicane/base/file.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/recording/replay.hpp"
#include "chicane/run/parallel.hpp"
#include "chicane/sweep/result_file.hpp"
#include "chicane/sweep/trial.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace chicane::apps {
namespace {

constexpr int kKeptMemory = 1 << 30;  // [byte] more than a run allocates at a time; chosen

/// Time left with two digits or more: in minutes from 90 s on, in hours from 90 min on.
std::string time_left(double seconds) {
  if (seconds < 90.0) return fmt::format("{:.0f} s", seconds);
  if (seconds < 90.0 * 60.0) return fmt::format("{:.0f} min", seconds / 60.0);
  return fmt::format("{:.1f} h", seconds / 3600.0);
}

/// Drives the plan by its rule, or as a sweep does.
Result<sweep::Progress> drive(const PlanRuns& runs, const sweep::SweepOptions& options,
                              const std::atomic<bool>& stop) {
  return runs.rule ? sweep::drive_plan(runs.plan, {}, options, runs.rule, stop)
                   : sweep::drive_plan(runs.plan, {}, options, stop);
}

/// Name of a run in messages: its command line; with a rule of its own the values of the axes.
std::string name_of(const PlanRuns& runs, std::uint64_t run) {
  if (!runs.rule) return sweep::command_of(runs.plan.settings_of(run));
  std::string name;
  for (const auto& [key, text] : runs.plan.at(run)) name += (name.empty() ? "" : ", ") + text;
  return name;
}

}  // namespace

std::atomic<bool>& begin_many_runs() {
  static std::atomic<bool> stop{false};  // static: must outlive the last signal
#ifdef __GLIBC__
  ::mallopt(M_MMAP_THRESHOLD, kKeptMemory);
  ::mallopt(M_TRIM_THRESHOLD, kKeptMemory);
#endif
  catch_interrupts(stop);
  return stop;
}

Result<void> write_below(const std::string& page, std::string_view marker, const std::string& text) {
  const std::string older = protocol::read_file(page).value_or("");
  const std::size_t end = older.find(marker);
  const std::string above = end == std::string::npos ? "" : older.substr(0, end);
  return write_file(page, above + std::string(marker) + text);
}

void RunCounter::show(std::uint64_t done, std::uint64_t runs, std::uint64_t driven) {
  if (!line_.is_due()) return;
  const double seconds = line_.seconds();
  const double speed = seconds > 0.0 ? static_cast<double>(driven) / seconds : 0.0;
  const std::string left = speed > 0.0 ? time_left(static_cast<double>(runs - done) / speed) : "?";
  line_.show(fmt::format("{} of {} {}, {:.1f} a second, {} left", done, runs, what_, speed, left));
}

std::function<void(const sweep::Progress&)> RunCounter::follow() {
  return [this](const sweep::Progress& progress) {
    show(progress.found + progress.driven, progress.runs, progress.driven);
  };
}

Result<RunLines> drive_runs(const PlanRuns& runs, int jobs, const std::string& results,
                            const std::atomic<bool>& stop) {
  const recording::TemporaryFile unnamed(".jsonl");
  const std::string& file = results.empty() ? unnamed.path() : results;
  RunCounter counter(runs.what);
  const auto done =
      drive(runs, {.jobs = run::threads_for(jobs), .file = file, .on_progress = counter.follow()}, stop);
  counter.end();
  if (!done) return fail(done.error());
  RunLines found{.lines = {}, .progress = *done};
  const auto keep = [&](std::uint64_t run, const protocol::Json& line) -> Result<void> {
    found.lines[run] = line;
    return {};
  };
  const auto accept = [](const sweep::Header&) { return Result<void>{}; };
  const auto read = sweep::read_runs(file, accept, keep);
  if (!read) return fail(read.error());
  for (const auto& [run, line] : found.lines)
    if (!runs.keeps_failed && line.contains("error"))
      return fail(ErrorCode::kInvalidArgument,
                  fmt::format("{}: {}", name_of(runs, run), line["error"].get<std::string>()));
  if (!done->is_complete())
    fmt::print(stderr, "stopped after {} of {} {}{}\n", done->found + done->driven, done->runs, runs.what,
               results.empty() ? "" : ": the same command goes on with what is missing");
  return found;
}

void print_rows(protocol::Json rows) {
  fmt::print("{}\n",
             protocol::json_text(protocol::Json{{"rows", std::move(rows)}}, protocol::JsonLayout::kIndented));
}

void print_table(const Options& options, const sweep::ResultTable& table) {
  if (options.is_json) return print_rows(table.json());
  fmt::print("{}", options.is_markdown ? table.markdown() : table.text());
}

}  // namespace chicane::apps
