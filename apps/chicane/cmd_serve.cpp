// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include "chicane/live/assets.hpp"
#include "chicane/live/live_settings.hpp"
#include "chicane/live/pages.hpp"
#include "chicane/live/run_limit.hpp"
#include "chicane/protocol/json_report.hpp"
#include "chicane/run/make.hpp"
#include "chicane/wire/serve.hpp"
#include "chicane/wire/viewer.hpp"
#include "commands.hpp"
#include "experiment.hpp"
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

constexpr const char* kUntold = "nobody told on which road the simulator drives: --track does";

/// What viewers are told of the run.
protocol::Run description(const scenario::Scenario& scenario, const controller::Controller& controller,
                          const std::optional<path::Track>& track) {
  protocol::Run run;
  run.mode = "serve";
  protocol::describe(controller, run);
  run.preset = scenario.preset;
  run.latency = scenario.latency;
  run.control_period = scenario.control_period;
  run.vehicle = scenario.vehicle;
  if (track) describe(*track, run);
  run.limit = track ? live::RunLimit::first_answer(*track) : lap_time::LimitAnswer{.why_not = kUntold};
  return run;
}

Result<wire::ServeSummary> run(const Options& options) {
  static std::atomic<bool> stop{false};  // as long as signals may come
  catch_interrupts(stop);
  const Result<scenario::Scenario> scenario = experiment(options);
  if (!scenario) return fail(scenario.error());
  Result<std::unique_ptr<controller::Controller>> controller = run::make_controller(*scenario);
  if (!controller) return fail(controller.error());
  const Result<std::optional<path::Track>> track = told_track(options, *scenario);
  if (!track) return fail(track.error());

  wire::ServeOptions serving;
  serving.server.address = options.address;
  serving.server.port = options.port;
  serving.vehicle = scenario->vehicle;
  serving.scenario = *scenario;
  if (*track) serving.track = &**track;
  serving.latency =
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(scenario->latency));
  wire::ViewerOptions viewing;
  viewing.run = description(*scenario, **controller, *track);
  const auto kept = KeptRun::start(options, viewing.run, *scenario,
                                   std::chrono::duration<double>(serving.step_budget).count());
  if (!kept) return fail(kept.error());
  run::ChangeQueue wishes;
  live::LiveSettings settings({.scenario = *scenario, .has_world = false}, wishes);
  viewing.parameters = &settings;
  wire::ViewerEndpoint viewer(std::move(viewing));
  live::RunLimit limit([&](const lap_time::LimitAnswer& news) { viewer.set_limit(news); });
  if (!*track) limit.give_up(kUntold);
  Progress progress;
  double last_time = 0.0;  // the control thread's
  wire::ServeHooks hooks;
  hooks.wishes = &wishes;
  hooks.on_change = [&](const telemetry::Change& change) {
    (*kept)->record(change);
    settings.tell(change);
  };
  hooks.pages = live::live_pages(settings);
  hooks.on_frame = [&](const telemetry::Frame& frame) {
    if (auto news = limit.news()) (*kept)->record(std::move(news));
    (*kept)->record(frame);
    viewer.publish(frame);
    last_time = frame.time;
    progress.show(frame);
  };
  hooks.on_lap = [&](const telemetry::CompletedLap& lap) {
    (*kept)->record(lap);
    viewer.publish(lap, last_time);
    progress.say(line_of(lap));
  };
  hooks.log = [&](std::string_view line) { progress.say(line); };
  hooks.on_listening = [&](std::uint16_t port) {
    progress.say(fmt::format(
        "{} ({}) waits for a simulator on port {}; dashboard at http://localhost:{}/; Ctrl-C ends",
        scenario->preset, scenario->controller, port, port));
    if (*track) limit.search(**track, *scenario);
  };
  hooks.on_end = [&] { limit.end(); };
  auto summary = wire::serve(serving, std::move(*controller), std::move(hooks), &viewer, live::embedded_assets(), stop);
  if (summary) compare_with_limit(limit, summary->run, **kept, stop);
  if (const Result<void> done = (*kept)->finish(); summary && !done) return fail(done.error());
  return summary;
}

}  // namespace

ExitCode serve(const Options& options) {
  const Result<wire::ServeSummary> summary = run(options);
  if (!summary) return report(summary.error());
  fmt::print(stderr, "{} answers to {} simulators; {} unusable messages, {} commands changed by the gate\n",
             summary->answers, summary->connections, summary->unusable, summary->interventions);
  fmt::print("{}", options.is_json ? protocol::to_json(summary->run) : protocol::to_table(summary->run));
  return kSuccess;
}

}  // namespace chicane::apps
