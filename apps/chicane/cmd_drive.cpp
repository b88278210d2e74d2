// SPDX-License-Identifier: MIT
// `chicane drive`, a run of controller and simulator, live or fast; and `chicane limit`, the limit of a
// plant.
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <memory>
#include <optional>
#include <utility>

#include "chicane/base/file.hpp"
#include "chicane/live/live_run.hpp"
#include "chicane/live/pages.hpp"
#include "chicane/protocol/json_report.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/make.hpp"
#include "chicane/run/plan_cache.hpp"
#include "chicane/run/racing.hpp"
#include "chicane/run/run_steps.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "program.hpp"
#include "progress.hpp"

namespace chicane::apps {
namespace {

/// Whether a run may continue until it is stopped: it has a dashboard, and no number of laps is given.
bool may_stay(const Options& options) {
  return !has_setting(options, "laps") && !options.is_fast && !options.is_json;
}

/// Whether a person watches the terminal and can end the program.
bool is_watched() { return isatty(STDOUT_FILENO) == 1 && isatty(STDERR_FILENO) == 1; }

/// Asset of the page with the command that starts the program; run.sh sets it.
net::Asset command_name() {
  const char* const name = std::getenv("CHICANE_COMMAND");
  return {"/command.txt", "text/plain; charset=utf-8", name == nullptr ? "chicane" : name};
}

/// Results of a run; they are printed even if the recording failed.
struct Outcome {
  telemetry::RunSummary summary;
  Result<void> kept;  ///< error of recording or report
  bool was_stopped;   ///< ended by the user, not by its laps
};

/// Drives by the clock, with a dashboard.
Result<Outcome> run_live(const Options& options, std::unique_ptr<run::ClosedLoop> loop,
                         net::ServerOptions server, run::RunControls& controls) {
  const bool drives_on = loop->scenario().laps == 0 && may_stay(options);
  const bool stays = drives_on || (may_stay(options) && is_watched());
  live::LiveRunOptions living{.stay_at_end = stays, .pace = options.pace, .is_manual = options.is_manual};
  living.assets = live::embedded_assets();
  living.assets.push_back(command_name());
  living.server = std::move(server);
  if (options.step_budget_ms) living.step_budget = 1e-3 * *options.step_budget_ms;
  const scenario::Scenario scenario = loop->scenario();
  const auto live = live::LiveRun::create(living, std::move(loop), controls);
  if (!live) return fail(live.error());
  const auto kept = KeptRun::start(options, (*live)->description(), scenario, (*live)->step_budget());
  if (!kept) return fail(kept.error());
  print_sentence(stderr, fmt::format("dashboard at {} (Ctrl-C ends)", link(living.server, (*live)->port())));
  telemetry::RunSummary summary;
  {
    Progress progress;
    summary = (*live)->run((*kept)->recorder(),
                           {.on_frame = [&](const telemetry::Frame& frame) { progress.show(frame); },
                            .say = [&](std::string_view line) { progress.say(line); }});
  }
  return Outcome{std::move(summary), (*kept)->finish(), stays};
}

// Reasons why a run has no limit. A recording has kNotLookedFor, because its reader can no longer give
// options.
constexpr const char* kNotAsked = "not asked for (--limit)";
constexpr const char* kModelCar = "it is computed for cars in full size";
constexpr const char* kNotLookedFor = "this run was driven without looking for it";

/// Limit for the summary of a run, or the reason why there is none.
lap_time::LimitAnswer answer_of(const road::Track& track, const lap_time::PlantLimit& limit) {
  if (!limit.is_whole())
    return {.why_not = limit.is_cut_short
                           ? "its search has used up its budget; `chicane limit` has one to set"
                           : lap_time::kNoOptimum};
  return {.found = std::make_shared<const lap_time::Limit>(lap_time::bound_from_start(track, limit))};
}

/// Limit for --limit, with the laps for --explain.
Result<lap_time::LimitAnswer> asked_limit(const Options& options, const run::ClosedLoop& loop,
                                          const run::RunControls& controls) {
  const bool is_model = loop.scenario().vehicle.scale != 1.0;
  if (!options.wants_limit) return lap_time::LimitAnswer{.why_not = is_model ? kModelCar : kNotAsked};
  double wall_time = 0.0;
  const auto found =
      limit_of(loop.scenario(), loop.track(), {.wants_witness = false}, controls.wants_stop, wall_time);
  if (!found) return fail(found.error());
  lap_time::LimitAnswer limit = answer_of(loop.track(), *found);
  if (!options.wants_causes || !limit.found) return limit;
  fmt::print(stderr, "driving again without each cause of the gap\n");
  auto laps = run::laps_without(loop.scenario(), [&] { return !controls.wants_stop.load(); });
  if (!laps) return fail(laps.error());
  limit.without = std::move(*laps);
  return limit;
}

/// Drives as fast as possible, without a dashboard.
Result<Outcome> run_fast(const Options& options, run::ClosedLoop& loop, const run::RunControls& controls) {
  Result<lap_time::LimitAnswer> asked = asked_limit(options, loop, controls);
  if (!asked) return fail(asked.error());
  lap_time::LimitAnswer& limit = *asked;
  protocol::Run description = live::description(loop);
  description.limit = limit;
  if (!options.wants_limit) description.limit.why_not = kNotLookedFor;
  const auto kept = KeptRun::start(options, std::move(description), loop.scenario(), 0.0);
  if (!kept) return fail(kept.error());
  telemetry::RunSummary summary;
  {
    Progress progress;
    summary =
        run::run_closed_loop(loop,
                             {.on_frame =
                                  [&](const telemetry::Frame& frame) {
                                    (*kept)->record(frame);
                                    progress.show(frame);
                                  },
                              .on_lap = [&](const telemetry::CompletedLap& lap) { (*kept)->record(lap); },
                              .on_change = [&](const telemetry::Change& change) { (*kept)->record(change); }},
                             [&] { return controls.wants_stop.load(); });
  }
  // A limit from the cache is for people: JSON and recordings must not depend on a cache.
  const bool may_know = !options.wants_limit && !options.is_json;
  if (const auto known = may_know ? run::known_limit(loop.scenario(), loop.track()) : std::nullopt)
    limit = answer_of(loop.track(), *known);
  if (limit.found) telemetry::compare_with_limit(summary, limit.found->times);
  summary.why_no_limit = limit.why_not;
  summary.without = limit.without;
  return Outcome{std::move(summary), (*kept)->finish(), false};
}

/// Makes the run with its planned lap, and shows the progress of the plan.
Result<std::unique_ptr<run::ClosedLoop>> planned(const scenario::Scenario& scenario,
                                                 std::optional<net::ServerOptions>* server) {
  PlanWait wait(scenario, server);
  Result<std::unique_ptr<run::ClosedLoop>> loop = prepared(scenario, wait.hooks());
  if (!wait.opened()) return fail(wait.opened().error());
  return loop;
}

/// Runs `chicane drive` up to its results.
Result<Outcome> run(const Options& options) {
  static run::RunControls controls;  // static: must outlive the last signal
  catch_interrupts(controls.wants_stop);
  const Result<scenario::Scenario> scenario = experiment(options);
  if (!scenario) return fail(scenario.error());
  std::optional<net::ServerOptions> server;
  if (!options.is_fast) {
    Result<net::ServerOptions> made = server_options(options);
    if (!made) return fail(made.error());
    server = std::move(*made);
  }
  Result<std::unique_ptr<run::ClosedLoop>> loop = planned(*scenario, &server);
  if (!loop) return fail(loop.error());
  if (may_stay(options) && options.scenario_file.empty() && (*loop)->track().centre().is_closed())
    (*loop)->apply(telemetry::Change{.name = "laps", .value = "0"});
  print_guard_notice(options, (*loop)->scenario().guard);
  print_notices((*loop)->scenario());
  return options.is_fast ? run_fast(options, **loop, controls)
                         : run_live(options, std::move(*loop), std::move(*server), controls);
}

}  // namespace

ExitCode drive(const Options& options) {
  const Result<Outcome> outcome = run(options);
  if (!outcome && run::must_stop_planning()) {
    fmt::print(stderr, "stopped before the run began\n");
    return kRunFailed;
  }
  if (!outcome) return report(outcome.error());
  const telemetry::RunSummary& summary = outcome->summary;
  fmt::print("{}", options.is_json ? protocol::to_json(summary) : protocol::to_table(summary));
  if (!outcome->kept) return report(outcome->kept.error());
  const bool is_success = outcome->was_stopped ? summary.off_track_events == 0 : completed_on_road(summary);
  return is_success ? kSuccess : kRunFailed;
}

namespace {

/// Runs `chicane limit`.
Result<void> print_limit(const Options& options) {
  static std::atomic<bool> wants_stop{false};  // static: must outlive the last signal
  catch_interrupts(wants_stop);
  const Result<scenario::Scenario> scenario = experiment(options);
  if (!scenario) return fail(scenario.error());
  const Result<road::Track> track = run::make_track(*scenario);
  if (!track) return fail(track.error());
  print_notices(*scenario);
  if (!options.csv_file.empty()) {
    if (Result<void> writable = check_writable(options.csv_file); !writable) return writable;
  }
  LimitRun limit_run{.track = track->name(), .car = scenario->car};
  const Result<lap_time::PlantLimit> limit =
      limit_of(*scenario, *track, {.budget = options.limit_budget}, wants_stop, limit_run.wall_time);
  if (!limit) return fail(limit.error());
  if (!options.csv_file.empty()) {
    if (Result<void> kept = write_file(options.csv_file, to_csv(limit_run, *track, *limit)); !kept)
      return kept;
  }
  fmt::print("{}", options.is_json ? to_json(limit_run, *limit) : to_table(limit_run, *limit));
  return {};
}

}  // namespace

ExitCode limit(const Options& options) {
  const Result<void> done = print_limit(options);
  return done ? kSuccess : report(done.error());
}

}  // namespace chicane::apps
