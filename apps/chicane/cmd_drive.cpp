// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <memory>

#include "chicane/protocol/json_report.hpp"
#include "chicane/runtime/assets.hpp"
#include "chicane/runtime/closed_loop.hpp"
#include "chicane/runtime/realtime_loop.hpp"
#include "chicane/runtime/viewer.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "interrupt.hpp"
#include "progress.hpp"

namespace chicane::apps {
namespace {

constexpr double kRoadSpacing = 2.0;  // [m] between the drawn points of the road

/// Somebody watches: the dashboard stays up after the last lap. Scripts, and whoever asked for a number of
/// laps, get an end.
bool stays_up(const Options& options) {
  const bool has_laps = std::any_of(options.settings.begin(), options.settings.end(),
                                    [](const auto& setting) { return setting.first == "laps"; });
  const bool is_watched = isatty(STDOUT_FILENO) == 1 && isatty(STDERR_FILENO) == 1;
  return is_watched && !has_laps && !options.is_fast && !options.is_json;
}

runtime::ViewerOptions viewing(const runtime::ClosedLoop& loop, runtime::RunControls& controls) {
  const scenario::Scenario& scenario = loop.scenario();
  runtime::ViewerOptions viewing;
  viewing.run = {.track = loop.track().name(),
                 .track_length = loop.track().centre().length(),
                 .is_closed = loop.track().centre().is_closed(),
                 .controller = scenario.controller,
                 .preset = scenario.preset,
                 .latency = scenario.latency,
                 .control_period = scenario.control_period,
                 .vehicle = scenario.vehicle,
                 .road = protocol::road_lines(loop.track(), kRoadSpacing)};
  viewing.services.pause = [&controls](bool is_paused) -> Result<void> {
    controls.is_paused = is_paused;
    return {};
  };
  viewing.services.step = [&controls]() -> Result<void> {
    if (!controls.is_paused) return fail(ErrorCode::kInvalidArgument, "the run is not paused");
    ++controls.steps;
    return {};
  };
  viewing.services.reset = [&controls]() -> Result<void> {
    controls.wants_restart = true;
    return {};
  };
  return viewing;
}

Result<telemetry::RunSummary> run_with_dashboard(const Options& options, runtime::ClosedLoop& loop,
                                                 runtime::RunControls& controls) {
  runtime::ViewerEndpoint viewer(viewing(loop, controls));
  runtime::Router router(nullptr, &viewer);
  const auto server = net::Server::create({.address = options.address, .port = options.port},
                                          router.handlers(), runtime::embedded_assets());
  if (!server) return fail(server.error());
  fmt::print(stderr, "dashboard at http://localhost:{}/; Ctrl-C ends\n", (*server)->port());
  Progress progress;
  return runtime::run_realtime(loop, {.stay_at_end = stays_up(options)}, controls,
                               [&](const telemetry::Frame& frame) {
                                 viewer.publish(frame);
                                 progress.show(frame);
                               });
}

telemetry::RunSummary run_fast(runtime::ClosedLoop& loop, const runtime::RunControls& controls) {
  Progress progress;
  return runtime::run_closed_loop(
      loop, [&](const telemetry::Frame& frame) { progress.show(frame); },
      [&] { return controls.wants_stop.load(); });
}

Result<telemetry::RunSummary> run(const Options& options) {
  static runtime::RunControls controls;  // as long as signals may come
  catch_interrupts(controls.wants_stop);
  const Result<scenario::Scenario> scenario = experiment(options);
  if (!scenario) return fail(scenario.error());
  const Result<std::unique_ptr<runtime::ClosedLoop>> loop = runtime::ClosedLoop::create(*scenario);
  if (!loop) return fail(loop.error());
  if (options.is_fast) return run_fast(**loop, controls);
  return run_with_dashboard(options, **loop, controls);
}

}  // namespace

ExitCode drive(const Options& options) {
  const Result<telemetry::RunSummary> summary = run(options);
  if (!summary) return report(summary.error());
  fmt::print("{}", options.is_json ? protocol::to_json(*summary) : protocol::to_table(*summary));
  const bool is_kept = stays_up(options) ? summary->off_track_events == 0 : kept_its_promises(*summary);
  return is_kept ? kSuccess : kBrokenPromise;
}

}  // namespace chicane::apps
