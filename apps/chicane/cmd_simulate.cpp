// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <atomic>
#include <utility>

#include "chicane/live/description.hpp"
#include "chicane/live/run_limit.hpp"
#include "chicane/protocol/json_report.hpp"
#include "chicane/run/make.hpp"
#include "chicane/wire/simulate.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "record.hpp"

namespace chicane::apps {
namespace {

/// Our road and car; the controller is not known.
protocol::Run description_of_external(const scenario::Scenario& scenario, const path::Track& track) {
  protocol::Run run;
  run.controller = run.preset = "external";
  run.vehicle = scenario.vehicle;
  run.mode = recording::kSimulateMode;
  run.limit = live::RunLimit::first_answer(track);
  live::describe(track, run);
  return run;
}

Result<wire::SimulateReport> connect_and_drive(const Options& options) {
  static std::atomic<bool> stop{false};  // as long as signals may come
  catch_interrupts(stop);
  const Result<scenario::Scenario> scenario = experiment(options);
  if (!scenario) return fail(scenario.error());
  wire::SimulateOptions simulating;
  simulating.url = options.connect;
  simulating.server_command = options.server;
  const Result<path::Track> track = run::make_track(*scenario);
  if (!track) return fail(track.error());
  const auto kept = KeptRun::start(options, description_of_external(*scenario, *track), *scenario, 0.0);
  if (!kept) return fail(kept.error());
  live::RunLimit limit;
  limit.search(*track, *scenario);
  Result<wire::SimulateReport> done;
  {
    Progress progress;
    done = wire::simulate(simulating, *scenario,
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
                           .log = [&](std::string_view line) { progress.say(line); }},
                          stop);
  }
  if (done) {
    if (limit.is_awaited(done->run) && !stop)
      fmt::print(stderr, "the limit is still being computed; Ctrl-C does without\n");
    limit.compare(done->run, stop);
    if (auto news = limit.news()) (*kept)->record(std::move(news));
  }
  if (const Result<void> finished = (*kept)->finish(); done && !finished) return fail(finished.error());
  return done;
}

}  // namespace

ExitCode simulate(const Options& options) {
  const Result<wire::SimulateReport> done = connect_and_drive(options);
  if (!done) return report(done.error());
  fmt::print("{}", options.is_json ? protocol::to_json(done->run) : protocol::to_table(done->run));
  fmt::print(stderr, "{} answers in {} connections; {} broken, {} unasked for, {} missing\n", done->answers,
             done->connections, done->broken_answers, done->extra_answers, done->silences);
  return completed_on_road(done->run) ? kSuccess : kRunFailed;
}

}  // namespace chicane::apps
