// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <memory>

#include "chicane/runtime/assets.hpp"
#include "chicane/runtime/live_settings.hpp"
#include "chicane/runtime/make.hpp"
#include "chicane/runtime/serve.hpp"
#include "chicane/runtime/viewer.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "record.hpp"

namespace chicane::apps {
namespace {

Result<runtime::ServeSummary> run(const Options& options) {
  static std::atomic<bool> stop{false};  // as long as signals may come
  catch_interrupts(stop);
  const Result<scenario::Scenario> scenario = experiment(options);
  if (!scenario) return fail(scenario.error());
  const Result<std::unique_ptr<controller::Controller>> controller = runtime::make_controller(*scenario);
  if (!controller) return fail(controller.error());

  runtime::ServeOptions serving;
  serving.server.address = options.address;
  serving.server.port = options.port;
  serving.vehicle = scenario->vehicle;
  serving.scenario = *scenario;
  serving.latency =
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(scenario->latency));
  runtime::ViewerOptions viewing;
  viewing.run.mode = "serve";
  protocol::describe(**controller, viewing.run);
  viewing.run.preset = scenario->preset;
  viewing.run.latency = scenario->latency;
  viewing.run.control_period = scenario->control_period;
  viewing.run.vehicle = scenario->vehicle;
  const auto kept = KeptRun::start(options, viewing.run, *scenario,
                                   std::chrono::duration<double>(serving.step_budget).count());
  if (!kept) return fail(kept.error());
  runtime::ChangeQueue wishes;
  runtime::LiveSettings settings({.scenario = *scenario, .has_world = false}, wishes);
  viewing.parameters = &settings;
  runtime::ViewerEndpoint viewer(std::move(viewing));
  Progress progress;
  runtime::ServeHooks hooks;
  hooks.wishes = &wishes;
  hooks.on_change = [&](const telemetry::Change& change) {
    (*kept)->record(change);
    settings.tell(change);
  };
  hooks.pages = runtime::live_pages(settings);
  hooks.on_frame = [&](const telemetry::Frame& frame) {
    (*kept)->record(frame);
    viewer.publish(frame);
    progress.show(frame);
  };
  hooks.log = [&](std::string_view line) { progress.say(line); };
  hooks.on_listening = [&](std::uint16_t port) {
    progress.say(fmt::format(
        "{} ({}) waits for a simulator on port {}; dashboard at http://localhost:{}/; Ctrl-C ends",
        scenario->preset, scenario->controller, port, port));
  };
  auto summary =
      runtime::serve(serving, **controller, std::move(hooks), &viewer, runtime::embedded_assets(), stop);
  if (const Result<void> done = (*kept)->finish(); summary && !done) return fail(done.error());
  return summary;
}

}  // namespace

ExitCode serve(const Options& options) {
  const Result<runtime::ServeSummary> summary = run(options);
  if (!summary) return report(summary.error());
  fmt::print("{} answers to {} simulators; {} unusable messages, {} commands changed by the gate\n",
             summary->answers, summary->connections, summary->unusable, summary->interventions);
  return kSuccess;
}

}  // namespace chicane::apps
