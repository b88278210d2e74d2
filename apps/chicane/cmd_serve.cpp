// SPDX-License-Identifier: MIT
// `chicane serve`, which drives the car of another program, and `chicane simulate`, whose car another program
// drives.
#include "cmd_serve.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "chicane/live/pages.hpp"
#include "chicane/live/run_limit.hpp"
#include "chicane/protocol/json_report.hpp"
#include "chicane/run/make.hpp"
#include "chicane/run/plan_cache.hpp"
#include "chicane/run/racing.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "program.hpp"
#include "progress.hpp"

namespace chicane::apps {
namespace {

/// Description of a run whose controller is another program.
protocol::Run description_of_external(const scenario::Scenario& scenario, const road::Track& track) {
  protocol::Run run;
  run.controller = run.preset = "external";
  live::describe(scenario, run);
  run.mode = recording::kSimulateMode;
  run.limit = live::RunLimit::first_answer(track);
  live::describe(track, run);
  return run;
}

/// Runs `chicane serve` up to its results.
Result<wire::ServeSummary> serve_until_stopped(const Options& options) {
  static std::atomic<bool> stop{false};  // static: must outlive the last signal
  let_interrupts_end();
  Result<scenario::Scenario> scenario = experiment(options);
  if (!scenario) return fail(scenario.error());
  Result<std::optional<road::Track>> track = given_track(options, *scenario);
  if (!track) return fail(track.error());
  return drive_external_car(
      options, std::move(*scenario), std::move(*track),
      [](std::uint16_t port) { return fmt::format("a simulator on port {}", port); }, stop,
      [&options](wire::ServeOptions serving, auto&&... rest) {
        serving.clock.lock_step = 1e-3 * options.lock_step_ms;
        serving.time_field = options.sim_time;
        return wire::serve(serving, std::forward<decltype(rest)>(rest)...);
      });
}

/// Runs `chicane simulate` up to its results.
Result<wire::SimulateReport> connect_and_drive(const Options& options) {
  static std::atomic<bool> stop{false};  // static: must outlive the last signal
  catch_interrupts(stop);
  wire::SimulateOptions simulating;
  simulating.url = options.connect;
  simulating.server_command = options.server;
  return drive_by_external(
      options, {}, stop,
      [&](const scenario::Scenario& scenario, const road::Track&, const wire::SimulateHooks& hooks) {
        return wire::simulate(simulating, scenario, hooks, stop);
      });
}

}  // namespace

Result<wire::ServeSummary> drive_external_car(const Options& options, scenario::Scenario scenario,
                                              std::optional<road::Track> track,
                                              const std::function<std::string(std::uint16_t)>& partner,
                                              std::atomic<bool>& stop, const live::ServeFunction& serve) {
  Result<std::unique_ptr<controller::Controller>> controller = run::make_controller(scenario);
  if (!controller) return fail(controller.error());
  // The recording has the source of the guard's road, so that a replay computes the same.
  if (!track) scenario.guard.road = safety::GuardRoad::kWaypoints;
  const Result<net::ServerOptions> listening = server_options(options);
  if (!listening) return fail(listening.error());
  std::optional<net::ServerOptions> server = *listening;
  catch_interrupts(stop);
  Result<std::shared_ptr<const road::RacingRoad>> planned;
  {
    PlanWait wait(scenario, &server);
    planned = run::plan_lap(scenario, track ? &*track : nullptr, wait.hooks());
    if (!wait.opened()) return fail(wait.opened().error());
  }
  if (!planned) return fail(planned.error());
  live::ServedRun served(*server, scenario, std::move(*controller), std::move(track), live::embedded_assets(),
                         std::move(*planned));
  const auto kept = KeptRun::start(options, served.description(), scenario, served.step_budget());
  if (!kept) return fail(kept.error());
  print_guard_notice(options, scenario.guard);
  print_notices(scenario);
  Progress progress;
  auto summary = served.run(
      (*kept)->recorder(),
      {.on_frame = [&](const telemetry::Frame& frame) { progress.show(frame); },
       .on_lap = [&](const telemetry::CompletedLap& lap) { progress.say(line_of(lap)); },
       .say = [&](std::string_view line) { progress.say(line); }},
      [&](std::uint16_t port) {
        progress.say(fmt::format("{} ({}) waits for {}; dashboard at {} (Ctrl-C ends)", scenario.preset,
                                 scenario.controller, partner(port), link(*server, port)));
      },
      stop, serve);
  if (const Result<void> done = (*kept)->finish(); summary && !done) return fail(done.error());
  return summary;
}

ExitCode print(const Options& options, const wire::ServeSummary& summary, std::string_view answers,
               std::string_view partners) {
  fmt::print(stderr, "{} {} to {} {}; {} unusable messages, {} commands changed by the gate\n",
             summary.answers, answers, summary.connections, partners, summary.unusable,
             summary.interventions);
  fmt::print("{}", options.is_json ? protocol::to_json(summary.run) : protocol::to_table(summary.run));
  return kSuccess;
}

Result<wire::SimulateReport> drive_by_external(const Options& options, const ExternalController& external,
                                               const std::atomic<bool>& stop,
                                               const SimulateFunction& simulate) {
  const Result<scenario::Scenario> scenario = experiment(options);
  if (!scenario) return fail(scenario.error());
  const Result<road::Track> track = run::make_track(*scenario);
  if (!track) return fail(track.error());
  const auto kept = KeptRun::start(options, description_of_external(*scenario, *track), *scenario, 0.0);
  if (!kept) return fail(kept.error());
  print_notices(*scenario);
  live::RunLimit limit;
  if (external.wants_limit) limit.search(*track, *scenario);
  Result<wire::SimulateReport> done;
  {
    Progress progress;
    if (external.on_start) progress.say(external.on_start(*scenario, *track));
    done = simulate(*scenario, *track,
                    {.on_frame =
                         [&](const telemetry::Frame& frame) {
                           if (auto news = limit.news()) (*kept)->record(std::move(news));
                           (*kept)->record(frame);
                           progress.show(frame);
                         },
                     .on_lap =
                         [&](const telemetry::CompletedLap& lap) {
                           (*kept)->record(lap);
                           progress.say(line_of(lap));
                         },
                     .log = [&](std::string_view line) { progress.say(line); }});
  }
  if (done && external.wants_limit) {
    if (limit.is_awaited(done->run) && !stop)
      fmt::print(stderr, "the limit is still being computed; Ctrl-C does without\n");
    limit.compare(done->run, stop);
    if (auto news = limit.news()) (*kept)->record(std::move(news));
  }
  if (const Result<void> finished = (*kept)->finish(); done && !finished) return fail(finished.error());
  return done;
}

ExitCode serve(const Options& options) {
  const Result<wire::ServeSummary> summary = serve_until_stopped(options);
  if (!summary && run::must_stop_planning()) {
    fmt::print(stderr, "stopped before the run began\n");
    return kRunFailed;
  }
  if (!summary) return report(summary.error());
  return print(options, *summary, "answers", "simulators");
}

ExitCode simulate(const Options& options) {
  const Result<wire::SimulateReport> done = connect_and_drive(options);
  if (!done) return report(done.error());
  fmt::print("{}", options.is_json ? protocol::to_json(done->run) : protocol::to_table(done->run));
  fmt::print(stderr, "{} answers in {} connections; {} broken, {} unasked for, {} missing\n", done->answers,
             done->connections, done->broken_answers, done->extra_answers, done->silences);
  return completed_on_road(done->run) ? kSuccess : kRunFailed;
}

}  // namespace chicane::apps
