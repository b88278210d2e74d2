// SPDX-License-Identifier: MIT
// `chicane sweep`, which drives many runs of one plan; `chicane merge`, which joins their results; and
// `chicane tune`, which searches the numbers of a preset by an optimiser.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "chicane/base/file.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/run/parallel.hpp"
#include "chicane/sweep/plan_codec.hpp"
#include "chicane/sweep/result_file.hpp"
#include "chicane/sweep/result_table.hpp"
#include "chicane/sweep/sweep.hpp"
#include "chicane/sweep/trial.hpp"
#include "chicane/sweep/tune.hpp"
#include "commands.hpp"
#include "lab/many_runs.hpp"

namespace chicane::apps {
namespace {

/// Shard of --shard, or of the environment.
Result<run::Shard> shard_of(const Options& options) {
  if (!options.sweep.shard.empty()) return run::parse_shard(options.sweep.shard);
  return run::environment_shard([](const char* name) { return std::getenv(name); });
}

/// File of results of the whole sweep.
std::string output_of(const Options& options) {
  if (!options.output_file.empty()) return options.output_file;
  return std::filesystem::path(options.sweep.plan_file).stem().string() + ".jsonl";
}

/// Prints the command of one run.
ExitCode show(const sweep::Plan& plan, double number) {
  const auto run = static_cast<std::uint64_t>(number);
  if (run >= plan.size())
    return report(Error{ErrorCode::kInvalidArgument,
                        fmt::format("--show: got {}, expected a run from 0 to {}", run, plan.size() - 1)});
  fmt::print("{}\n", sweep::command_of(plan.settings_of(run)));
  if (plan.search)
    fmt::print(stderr, "without {}, which is searched: search_value of its results\n", plan.search->key);
  return kSuccess;
}

}  // namespace

ExitCode drive_sweep(const Options& options) {
  const std::atomic<bool>& stop = begin_many_runs();
  const Result<sweep::Plan> plan = sweep::read_plan(options.sweep.plan_file);
  if (!plan) return report(plan.error());
  if (options.sweep.shown) return show(*plan, *options.sweep.shown);
  const Result<run::Shard> shard = shard_of(options);
  if (!shard) return report(shard.error());
  const std::string file = shard->file_of(output_of(options));
  if (!shard->from.empty())
    fmt::print(stderr, "part {} of {} ({}): {}\n", shard->index + 1, shard->count, shard->from, file);
  RunCounter counter;
  const auto done = sweep::drive_plan(
      *plan, *shard, {.jobs = run::threads_for(options.jobs), .file = file, .on_progress = counter.follow()},
      stop);
  counter.end();
  if (!done) return report(done.error());
  fmt::print(stderr, "{}: {} of {} runs{}\n", file, done->found + done->driven, done->runs,
             done->found > 0 ? fmt::format(", {} of them from before", done->found) : "");
  if (done->failed > 0) fmt::print(stderr, "{} cannot be driven: {}\n", done->failed, done->why);
  if (done->is_complete()) return kSuccess;
  fmt::print(stderr, "stopped: the same command goes on with what is missing\n");
  return kRunFailed;
}

ExitCode merge_results(const Options& options) {
  const auto merged = sweep::merge(options.files, options.output_file);
  if (!merged) return report(merged.error());
  fmt::print(stderr, "{}: {} runs{}\n", options.output_file, merged->runs,
             merged->repeated > 0 ? fmt::format(", {} of them came twice", merged->repeated) : "");
  if (options.csv_file.empty()) return kSuccess;
  const auto written = sweep::write_csv(options.output_file, options.csv_file);
  return written ? kSuccess : report(written.error());
}

namespace {

/// Verdict in words.
std::string words(const sweep::Verdict& verdict) {
  const std::string lap =
      std::isfinite(verdict.lap_time) ? fmt::format("{:.2f} s", verdict.lap_time) : "no lap";
  const std::string trials = verdict.is_clean()
                                 ? fmt::format("clean in {} trials", verdict.driven)
                                 : fmt::format("in {} trials {} times off the road, {} not finished",
                                               verdict.driven, verdict.off_track_events, verdict.unfinished);
  return fmt::format("{}, margin {:.3f} m, steering {:.3f} rad/s, {}", lap, verdict.margin,
                     verdict.steering_rate, trials);
}

/// Head of the preset that was found.
std::string description_of(const Options& options, const sweep::TuneTask& task, const sweep::Tuning& tuning) {
  std::string name = "a preset";
  for (const auto& [key, text] : task.settings)
    if (key == "preset") name = text;
  return fmt::format(
      "Tuning of {} for {} by `chicane tune`, {} with seed {}, {} evaluations: {}; by hand: {}", name,
      sweep::kObjectiveNames[static_cast<std::size_t>(task.objective)], options.tune.optimizer, task.seed,
      tuning.evaluations, words(tuning.found), words(tuning.by_hand));
}

/// Verdict as JSON, without the numbers of the search.
protocol::Json json_of(const sweep::Verdict& verdict) {
  protocol::Json json;
  sweep::Verdict::rows(verdict, [&](const char* name, auto value) { json[name] = value; });
  for (const char* name : {"progress", "passed"}) json.erase(name);
  return json;
}

/// Result of the tuning as JSON.
std::string json_of(const sweep::Tuning& tuning) {
  protocol::Json json{{"is_better", tuning.is_better},
                      {"evaluations", tuning.evaluations},
                      {"runs", tuning.runs},
                      {"by_hand", json_of(tuning.by_hand)},
                      {"found", json_of(tuning.found)}};
  for (const auto& [key, text] : tuning.values) json["values"][key] = text;
  return protocol::json_text(json, protocol::JsonLayout::kIndented);
}

/// Result of the tuning as text.
std::string text_of(const sweep::Tuning& tuning) {
  std::string text = fmt::format("by hand  {}\nfound    {}\n{} evaluations, {} runs", words(tuning.by_hand),
                                 words(tuning.found), tuning.evaluations, tuning.runs);
  for (const auto& [key, value] : tuning.values) text += fmt::format("\n  {}={}", key, value);
  if (!tuning.is_better) text += "\nno better tuning was found";
  return text;
}

/// Writes the best tuning as a preset.
Result<void> keep(const Options& options, const sweep::TuneTask& task, const sweep::Tuning& tuning) {
  const auto base = sweep::scenario_of(task.settings);
  sweep::Settings settings = task.settings;
  settings.insert(settings.end(), tuning.values.begin(), tuning.values.end());
  const auto found = sweep::scenario_of(settings);
  if (!base || !found) return fail(!base ? base.error() : found.error());
  return write_file(options.output_file,
                    protocol::write_preset(*found, *base, description_of(options, task, tuning)));
}

/// Enumerator of a name. Pre: one of `names`.
template <class Enum, std::size_t N>
Enum enumerator_of(const std::array<std::string_view, N>& names, std::string_view name) {
  return static_cast<Enum>(std::find(names.begin(), names.end(), name) - names.begin());
}

}  // namespace

ExitCode tune(const Options& options) {
  const std::atomic<bool>& stop = begin_many_runs();
  sweep::TuneTask task{.settings = options.settings,
                       .over = options.tune.over,
                       .evaluations = options.tune.evaluations,
                       .seed = options.tune.seed,
                       .jobs = run::threads_for(options.jobs),
                       .log = options.tune.log};
  if (!options.speed_mps.empty()) task.settings.emplace_back("speed_mps", options.speed_mps);
  task.objective = enumerator_of<sweep::Objective>(sweep::kObjectiveNames, options.tune.objective);
  task.optimizer = enumerator_of<sweep::Optimizer>(sweep::kOptimizerNames, options.tune.optimizer);
  if (const Result<void> writable = check_writable(options.output_file); !writable)
    return report(writable.error());
  RunCounter counter("evaluations");
  const auto tuning = sweep::tune(task, stop, [&](int evaluation, const sweep::Verdict* better) {
    counter.show(evaluation, task.evaluations, evaluation);
    if (better == nullptr) return;
    counter.end();
    fmt::print(stderr, "{:6} {}\n", evaluation, words(*better));
  });
  counter.end();
  if (!tuning) return report(tuning.error());
  fmt::print("{}\n", options.is_json ? json_of(*tuning) : text_of(*tuning));
  if (!tuning->is_better) return kRunFailed;
  if (options.output_file.empty()) return kSuccess;
  const Result<void> kept = keep(options, task, *tuning);
  return kept ? kSuccess : report(kept.error());
}

}  // namespace chicane::apps
