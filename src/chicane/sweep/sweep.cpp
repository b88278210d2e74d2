// SPDX-License-Identifier: MIT
// Drives the runs of a plan in parallel: once each, or searched for the largest clean value, into a file of
// results.
#include "chicane/sweep/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "chicane/base/text.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/sweep/plan_codec.hpp"
#include "chicane/sweep/result_file.hpp"
#include "chicane/sweep/trial.hpp"

namespace chicane::sweep {
namespace {

constexpr int kSearchDigits = 4;  // significant digits of a tried value: 12.35; chosen

/// Text as a JSON string.
std::string quoted(const std::string& text) { return protocol::json_text(protocol::Json(text)); }

/// Value of a setting as JSON: numbers and booleans as such, texts in quotes.
std::string setting_json(const std::string& key, const std::string& text) {
  const protocol::Parameter* row = protocol::find(key);
  const bool is_text = row != nullptr && (row->option.kind == protocol::Kind::kText ||
                                          row->option.kind == protocol::Kind::kChoice);
  const bool is_json = !is_text && !protocol::parse_json(text).is_discarded();
  return is_json ? text : quoted(text);
}

/// Progress counted by all threads, and the first error of writing the file.
class Tally {
 public:
  Tally(const SweepOptions& options, Progress progress) : options_{options}, progress_{progress} {}

  /// Counts a run. `why_not`: error if it cannot be driven; null if it was driven.
  void add(const Error* why_not) {
    const std::lock_guard lock(mutex_);
    ++progress_.driven;
    if (why_not != nullptr && progress_.failed++ == 0) progress_.why = why_not->message;
    if (options_.on_progress) options_.on_progress(progress_);
  }
  /// Keeps an error of writing the file, if it is the first.
  void fail_with(const Error& error) {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = error;
  }
  [[nodiscard]] Result<Progress> result() const {
    if (!error_) return progress_;
    return fail(error_->code,
                fmt::format("{} ({} of {} runs are done; the same command goes on with them)",
                            error_->message, progress_.found + progress_.driven, progress_.runs));
  }

 private:
  const SweepOptions& options_;
  std::mutex mutex_;
  Progress progress_;
  std::optional<Error> error_;
};

/// Line of a run with the members of a JSON object, or with the error if it cannot be driven.
std::string line_with(std::uint64_t run, const Settings& varied, const Result<std::string>& object) {
  std::string line = fmt::format("{{\"run\":{},\"settings\":{{", run);
  for (std::size_t i = 0; i < varied.size(); ++i) {
    const auto& [key, text] = varied[i];
    line += fmt::format("{}{}:{}", i == 0 ? "" : ",", quoted(key), setting_json(key, text));
  }
  return line + (object ? "}," + object->substr(1)
                        : fmt::format("}},\"error\":{}}}", quoted(object.error().message)));
}

/// Columns that the plan keeps, and always the state hash, as a JSON object.
std::string columns_of(const Plan& plan, const RunOutcome& outcome) {
  std::string text;
  if (plan.search)
    text += fmt::format("\"{}\":{},\"{}\":{}", kSearchValue,
                        std::isnan(outcome.search_value) ? "null" : number_text(outcome.search_value),
                        kSearchTrials, outcome.search_trials);
  const auto add = [&](const Column& column) {
    text += fmt::format("{}\"{}\":{}", text.empty() ? "" : ",", column.name, column.text(outcome.run));
  };
  if (plan.keep.empty())
    for (const Column& column : columns()) add(column);
  for (const std::string& name : plan.keep) add(*find_column(name));
  const bool has_hash =
      plan.keep.empty() || std::find(plan.keep.begin(), plan.keep.end(), "state_hash") != plan.keep.end();
  if (!has_hash) add(*find_column("state_hash"));
  return "{" + text + "}";
}

/// Search of find_largest(): down the ladder to the first clean value, then bisection.
class Searcher {
 public:
  Searcher(const Search& search, const Settings& settings, run::Roads& roads, const std::atomic<bool>& stop)
      : search_{search}, settings_{settings}, roads_{roads}, stop_{stop} {}

  Result<std::optional<RunOutcome>> find() {
    const std::vector<double> ladder = search_.ladder();
    for (const double value : ladder) {
      const Trial trial = drive_with(value, value == ladder.back());
      if (trial == Trial::kStopped) return std::optional<RunOutcome>{};
      if (trial == Trial::kClean) break;
    }
    if (found_.search_trials == 0) return fail(refusal_);
    while (found_.search_value > 0.0 && unclean_ > found_.search_value * (1.0 + search_.within)) {
      const double middle = std::sqrt(found_.search_value * unclean_);
      if (drive_with(middle, false) == Trial::kStopped) return std::optional<RunOutcome>{};
    }
    return std::optional(std::move(found_));
  }

 private:
  enum class Trial { kClean, kNotClean, kStopped };

  /// Drives with `wanted`, rounded to kSearchDigits. `is_last`: smallest value, whose run is the result even
  /// if it is not clean.
  Trial drive_with(double wanted, bool is_last) {
    const std::string text = number_text(wanted, kSearchDigits);
    const double value = number_in(text).value_or(wanted);
    Settings settings = settings_;
    settings.emplace_back(search_.key, text);
    auto driven = drive(settings, roads_, stop_, is_last ? Until::kItsEnd : Until::kOffRoad);
    if (!driven) {  // the controller refuses this value
      refusal_ = driven.error();
      unclean_ = value;
      return Trial::kNotClean;
    }
    if (!*driven) return Trial::kStopped;
    ++found_.search_trials;
    const bool is_clean = telemetry::completed_on_road(**driven);
    if (is_clean || is_last) found_.run = std::move(**driven);
    (is_clean ? found_.search_value : unclean_) = value;
    return is_clean ? Trial::kClean : Trial::kNotClean;
  }

  const Search& search_;
  const Settings& settings_;
  run::Roads& roads_;
  const std::atomic<bool>& stop_;
  RunOutcome found_;                                ///< result so far
  double unclean_ = 0.0;                            ///< smallest value that was not clean; 0: none yet
  Error refusal_{ErrorCode::kInvalidArgument, ""};  ///< error of the last value that could not be driven
};

/// Outcome of a run of a plan, driven once or searched.
Result<std::optional<RunOutcome>> outcome_of(const Plan& plan, std::uint64_t run, run::Roads& roads,
                                             const std::atomic<bool>& stop) {
  const Settings settings = plan.settings_of(run);
  if (plan.search) return find_largest(*plan.search, settings, roads, stop);
  auto driven = drive(settings, roads, stop);
  if (!driven) return fail(driven.error());
  if (!*driven) return std::optional<RunOutcome>{};
  return std::optional(RunOutcome{.run = std::move(**driven)});
}

}  // namespace

Result<std::optional<telemetry::RunSummary>> drive(const Settings& settings, run::Roads& roads,
                                                   const std::atomic<bool>& stop, Until until) {
  const Result<scenario::Scenario> scenario = scenario_of(settings);
  if (!scenario) return fail(scenario.error());
  const auto loop = run::ClosedLoop::create(*scenario, roads);
  if (!loop && stop) return std::optional<telemetry::RunSummary>{};  // planning was stopped
  if (!loop) return fail(loop.error());
  telemetry::RunSummary summary = run::run_closed_loop(**loop, {}, [&] {
    return stop.load() || (until == Until::kOffRoad && (*loop)->world().off_track_events > 0);
  });
  if (stop && !(*loop)->is_over()) return std::optional<telemetry::RunSummary>{};
  return std::optional(std::move(summary));
}

Result<std::optional<RunOutcome>> find_largest(const Search& search, const Settings& settings,
                                               run::Roads& roads, const std::atomic<bool>& stop) {
  return Searcher(search, settings, roads, stop).find();
}

std::string line_of(const Plan& plan, std::uint64_t run, const Settings& varied,
                    const Result<RunOutcome>& result) {
  return line_with(run, varied,
                   result ? Result<std::string>(columns_of(plan, *result)) : fail(result.error()));
}

Result<Progress> drive_plan(const Plan& plan, const run::Shard& shard, const SweepOptions& options,
                            const RunRule& rule, const std::atomic<bool>& stop) {
  Result<ResultFile> file = ResultFile::open(options.file, plan, shard);
  if (!file) return fail(file.error());
  const std::uint64_t shard_size = shard.size(plan.size());
  Tally tally(options, {.runs = shard_size, .found = file->done()});
  run::for_each_run(shard_size, options.jobs, [&](std::uint64_t i, run::Roads& roads) {
    const std::uint64_t run = i * shard.count + shard.index;
    if (file->has(run)) return !stop;
    if (stop) return false;
    const Result<std::optional<std::string>> driven = rule(run, roads);
    if (driven && !*driven) return false;
    const Result<std::string> object = driven ? Result<std::string>(**driven) : fail(driven.error());
    if (const Result<void> written = file->append(line_with(run, plan.at(run), object)); !written) {
      tally.fail_with(written.error());
      return false;
    }
    tally.add(object ? nullptr : &object.error());
    return true;
  });
  return tally.result();
}

Result<Progress> drive_plan(const Plan& plan, const run::Shard& shard, const SweepOptions& options,
                            const std::atomic<bool>& stop) {
  std::mutex mutex;  // guards options.on_run
  const RunRule rule = [&](std::uint64_t run, run::Roads& roads) -> Result<std::optional<std::string>> {
    const auto driven = outcome_of(plan, run, roads, stop);
    if (!driven) return fail(driven.error());
    if (!*driven) return std::optional<std::string>{};
    if (options.on_run) {
      const std::lock_guard lock(mutex);
      options.on_run(run, (*driven)->run);
    }
    return std::optional(columns_of(plan, **driven));
  };
  return drive_plan(plan, shard, options, rule, stop);
}

}  // namespace chicane::sweep
