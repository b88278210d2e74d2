// SPDX-License-Identifier: MIT
#include "plan_runs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "chicane/recording/temporary_file.hpp"
#include "chicane/run/parallel.hpp"
#include "chicane/sweep/result_file.hpp"
#include "chicane/sweep/trial.hpp"
#include "many_runs.hpp"

namespace chicane::apps {
namespace {

Result<sweep::Progress> drive(const PlanRuns& runs, const sweep::SweepOptions& options,
                              const std::atomic<bool>& stop) {
  return runs.rule ? sweep::drive_plan(runs.plan, {}, options, runs.rule, stop)
                   : sweep::drive_plan(runs.plan, {}, options, stop);
}

/// The command that drives a run, or what makes it different.
std::string name_of(const PlanRuns& runs, std::uint64_t run) {
  if (!runs.rule) return sweep::command_of(runs.plan.settings_of(run));
  std::string name;
  for (const auto& [key, text] : runs.plan.at(run)) name += (name.empty() ? "" : ", ") + text;
  return name;
}

}  // namespace

Result<RunLines> drive_runs(const PlanRuns& runs, int jobs, const std::string& results,
                            const std::atomic<bool>& stop) {
  const recording::TemporaryFile unnamed(".jsonl");
  const std::string& file = results.empty() ? unnamed.path() : results;
  RunCounter counter(runs.what);
  const auto done =
      drive(runs,
            {.jobs = run::threads_for(jobs),
             .file = file,
             .on_progress =
                 [&](const sweep::Progress& progress) {
                   counter.show(progress.found + progress.driven, progress.runs, progress.driven);
                 }},
            stop);
  counter.end();
  if (!done) return fail(done.error());
  RunLines found{.lines = {}, .progress = *done};
  const auto keep = [&](const sweep::LinePlace& place, const std::string& text) -> Result<void> {
    found.lines[place.run] = protocol::parse_json(text);
    return {};
  };
  if (const auto read = sweep::read_lines(file, keep); !read) return fail(read.error());
  for (const auto& [run, line] : found.lines)
    if (!runs.keeps_failed && line.contains("error"))
      return fail(ErrorCode::kInvalidArgument,
                  fmt::format("{}: {}", name_of(runs, run), line["error"].get<std::string>()));
  if (!done->is_complete())
    fmt::print(stderr, "stopped after {} of {} {}{}\n", done->found + done->driven, done->runs, runs.what,
               results.empty() ? "" : ": the same command goes on with what is missing");
  return found;
}

sweep::Axis list_axis(const char* key, std::vector<std::string> list) {
  sweep::Axis axis;
  axis.size = list.size();
  axis.dimensions.push_back({.key = key, .list = std::move(list)});
  return axis;
}

protocol::Json number_or_null(double value) {
  return std::isfinite(value) ? protocol::Json(value) : protocol::Json();
}

std::string members_of(const protocol::Json& object) {
  const std::string text = protocol::json_text(object);
  return text.substr(1, text.size() - 2);
}

}  // namespace chicane::apps
