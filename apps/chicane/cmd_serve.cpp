// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <utility>

#include "access.hpp"
#include "chicane/live/assets.hpp"
#include "chicane/live/served_run.hpp"
#include "chicane/protocol/json_report.hpp"
#include "chicane/run/make.hpp"
#include "chicane/run/racing.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "guard_notice.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "record.hpp"

namespace chicane::apps {
namespace {

/// The road of the simulator, where the command line says which; none where it does not.
Result<std::optional<path::Track>> told_track(const Options& options, const scenario::Scenario& scenario) {
  const bool is_told = std::any_of(options.settings.begin(), options.settings.end(),
                                   [](const auto& setting) { return setting.first == "track"; });
  if (!is_told) return std::optional<path::Track>{};
  Result<path::Track> track = run::make_track(scenario);
  if (!track) return fail(track.error());
  return std::optional<path::Track>{std::move(*track)};
}

Result<wire::ServeSummary> serve_until_stopped(const Options& options) {
  static std::atomic<bool> stop{false};  // as long as signals may come
  catch_interrupts(stop);
  Result<scenario::Scenario> scenario = experiment(options);
  if (!scenario) return fail(scenario.error());
  Result<std::unique_ptr<controller::Controller>> controller = run::make_controller(*scenario);
  if (!controller) return fail(controller.error());
  Result<std::optional<path::Track>> track = told_track(options, *scenario);
  if (!track) return fail(track.error());
  // What is recorded says where the guard knew the road from, so that a replay computes the same.
  if (!*track) scenario->guard.road = safety::GuardRoad::kWaypoints;

  const Result<net::ServerOptions> server = server_options(options);
  if (!server) return fail(server.error());
  auto planned = run::plan_lap(*scenario, *track ? &**track : nullptr);
  if (!planned) return fail(planned.error());
  live::ServedRun served(*server, *scenario, std::move(*controller), std::move(*track),
                         live::embedded_assets(), std::move(*planned));
  const auto kept = KeptRun::start(options, served.description(), *scenario, served.step_budget());
  if (!kept) return fail(kept.error());
  print_guard_notice(options, scenario->guard);
  Progress progress;
  auto summary = served.run(
      (*kept)->recorder(),
      {.on_frame = [&](const telemetry::Frame& frame) { progress.show(frame); },
       .on_lap = [&](const telemetry::CompletedLap& lap) { progress.say(line_of(lap)); },
       .say = [&](std::string_view line) { progress.say(line); }},
      [&](std::uint16_t port) {
        progress.say(fmt::format("{} ({}) waits for a simulator on port {}; dashboard at {} (Ctrl-C ends)",
                                 scenario->preset, scenario->controller, port, link(*server, port)));
      },
      stop);
  if (const Result<void> done = (*kept)->finish(); summary && !done) return fail(done.error());
  return summary;
}

}  // namespace

ExitCode serve(const Options& options) {
  const Result<wire::ServeSummary> summary = serve_until_stopped(options);
  if (!summary) return report(summary.error());
  fmt::print(stderr, "{} answers to {} simulators; {} unusable messages, {} commands changed by the gate\n",
             summary->answers, summary->connections, summary->unusable, summary->interventions);
  fmt::print("{}", options.is_json ? protocol::to_json(summary->run) : protocol::to_table(summary->run));
  return kSuccess;
}

}  // namespace chicane::apps
