// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/run/parallel.hpp"
#include "chicane/sweep/trial.hpp"
#include "chicane/sweep/tune.hpp"
#include "commands.hpp"
#include "interrupt.hpp"
#include "many_runs.hpp"

namespace chicane::apps {
namespace {

std::string words(const sweep::Verdict& verdict) {
  const std::string lap =
      std::isfinite(verdict.lap_time) ? fmt::format("{:.2f} s", verdict.lap_time) : "no lap";
  const std::string trials = verdict.is_clean() ? "clean in all trials"
                                                : fmt::format("{} times off the road, {} trials not finished",
                                                              verdict.off_track_events, verdict.unfinished);
  return fmt::format("{}, margin {:.2f} m, steering {:.3f} rad/s, {}", lap, verdict.margin,
                     verdict.steering_rate, trials);
}

std::string description_of(const Options& options, const sweep::TuneTask& task, const sweep::Tuning& tuning) {
  std::string name = "a preset";
  for (const auto& [key, text] : task.settings)
    if (key == "preset") name = text;
  return fmt::format(
      "Tuning of {} for {} by `chicane tune`, {} with seed {}, {} evaluations: {}; by hand: {}", name,
      sweep::kObjectiveNames[static_cast<std::size_t>(task.objective)], options.tune.optimizer, task.seed,
      tuning.evaluations, words(tuning.found), words(tuning.by_hand));
}

Result<void> keep(const Options& options, const sweep::TuneTask& task, const sweep::Tuning& tuning) {
  const auto base = protocol::compose(*sweep::request_of(task.settings));
  sweep::Settings settings = task.settings;
  settings.insert(settings.end(), tuning.values.begin(), tuning.values.end());
  const auto found = protocol::compose(*sweep::request_of(settings));
  if (!base || !found) return fail(!base ? base.error() : found.error());
  std::ofstream out(options.output_file, std::ios::trunc);
  out << protocol::write_preset(*found, *base, description_of(options, task, tuning));
  out.close();
  return out ? Result<void>{} : fail(ErrorCode::kIo, options.output_file + ": cannot be written");
}

}  // namespace

ExitCode tune(const Options& options) {
  keep_memory();
  static std::atomic<bool> stop{false};  // as long as signals may come
  catch_interrupts(stop);
  sweep::TuneTask task{.settings = options.settings,
                       .over = options.tune.over,
                       .evaluations = options.tune.evaluations,
                       .seed = options.tune.seed,
                       .jobs = run::threads_for(options.jobs)};
  if (!options.speed_mps.empty()) task.settings.emplace_back("speed_mps", options.speed_mps);
  for (std::size_t i = 0; i < sweep::kObjectiveNames.size(); ++i)
    if (sweep::kObjectiveNames[i] == options.tune.objective)
      task.objective = static_cast<sweep::Objective>(i);
  for (std::size_t i = 0; i < sweep::kOptimizerNames.size(); ++i)
    if (sweep::kOptimizerNames[i] == options.tune.optimizer)
      task.optimizer = static_cast<sweep::Optimizer>(i);
  const auto tuning = sweep::tune(task, stop, [](int evaluation, const sweep::Verdict& verdict) {
    fmt::print(stderr, "{:6} {}\n", evaluation, words(verdict));
  });
  if (!tuning) return report(tuning.error());
  fmt::print("by hand  {}\nfound    {}\n", words(tuning->by_hand), words(tuning->found));
  for (const auto& [key, text] : tuning->values) fmt::print("  {}={}\n", key, text);
  if (!tuning->is_better) {
    fmt::print("no better tuning was found in {} evaluations\n", tuning->evaluations);
    return kRunFailed;
  }
  if (options.output_file.empty()) return kSuccess;
  const Result<void> kept = keep(options, task, *tuning);
  return kept ? kSuccess : report(kept.error());
}

}  // namespace chicane::apps
