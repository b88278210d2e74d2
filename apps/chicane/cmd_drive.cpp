// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <memory>

#include "chicane/protocol/json_report.hpp"
#include "chicane/runtime/assets.hpp"
#include "chicane/runtime/closed_loop.hpp"
#include "chicane/runtime/realtime_loop.hpp"
#include "chicane/runtime/recorder.hpp"
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

protocol::Run description(const runtime::ClosedLoop& loop) {
  const scenario::Scenario& scenario = loop.scenario();
  protocol::Run run{.track = loop.track().name(),
                    .track_length = loop.track().centre().length(),
                    .is_closed = loop.track().centre().is_closed(),
                    .controller = scenario.controller,
                    .preset = scenario.preset,
                    .latency = scenario.latency,
                    .control_period = scenario.control_period,
                    .vehicle = scenario.vehicle,
                    .mode = "drive",
                    .kerb_width = loop.track().kerb_width(),
                    .road = protocol::road_lines(loop.track(), kRoadSpacing)};
  protocol::describe(loop.controller(), run);
  return run;
}

runtime::ViewerOptions viewing(const runtime::ClosedLoop& loop, runtime::RunControls& controls) {
  runtime::ViewerOptions viewing;
  viewing.run = description(loop);
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

/// --record: null when nobody asked for it.
Result<std::unique_ptr<runtime::Recorder>> start_recorder(const Options& options,
                                                          const runtime::ClosedLoop& loop) {
  if (options.record_file.empty()) return nullptr;
  const double budget = runtime::RealtimeOptions{}.budget_share * loop.scenario().control_period;
  return runtime::Recorder::create({.path = options.record_file,
                                    .run = description(loop),
                                    .scenario = loop.scenario(),
                                    .step_budget = options.is_fast ? 0.0 : budget,
                                    .may_wait = options.is_fast});
}

/// The results of a run, which are told even when its recording failed.
struct Outcome {
  telemetry::RunSummary summary;
  Result<void> recorded;
};

Outcome conclude(const Options& options, telemetry::RunSummary summary, runtime::Recorder* recorder) {
  if (recorder == nullptr) return {std::move(summary), {}};
  const Result<runtime::RecorderReport> report = recorder->finish();
  if (!report) return {std::move(summary), fail(report.error())};
  fmt::print(stderr, "{}: recorded {} steps, {:.1f} MB\n", options.record_file, report->frames,
             1e-6 * static_cast<double>(report->bytes));
  if (report->left_out > 0)
    fmt::print(stderr, "{}: the disk was too slow for {} steps\n", options.record_file, report->left_out);
  return {std::move(summary), {}};
}

Result<Outcome> run_with_dashboard(const Options& options, runtime::ClosedLoop& loop,
                                   runtime::RunControls& controls) {
  runtime::ViewerEndpoint viewer(viewing(loop, controls));
  runtime::Router router(nullptr, &viewer);
  const auto server = net::Server::create({.address = options.address, .port = options.port},
                                          router.handlers(), runtime::embedded_assets());
  if (!server) return fail(server.error());
  const auto recorder = start_recorder(options, loop);
  if (!recorder) return fail(recorder.error());
  fmt::print(stderr, "dashboard at http://localhost:{}/; Ctrl-C ends\n", (*server)->port());
  telemetry::RunSummary summary;
  {
    Progress progress;
    summary = runtime::run_realtime(loop, {.stay_at_end = stays_up(options)}, controls,
                                    [&](const telemetry::Frame& frame) {
                                      if (*recorder) (*recorder)->record(frame);
                                      viewer.publish(frame);
                                      progress.show(frame);
                                    });
  }
  return conclude(options, std::move(summary), recorder->get());
}

Result<Outcome> run_fast(const Options& options, runtime::ClosedLoop& loop,
                         const runtime::RunControls& controls) {
  const auto recorder = start_recorder(options, loop);
  if (!recorder) return fail(recorder.error());
  telemetry::RunSummary summary;
  {
    Progress progress;
    summary = runtime::run_closed_loop(
        loop,
        [&](const telemetry::Frame& frame) {
          if (*recorder) (*recorder)->record(frame);
          progress.show(frame);
        },
        [&] { return controls.wants_stop.load(); });
  }
  return conclude(options, std::move(summary), recorder->get());
}

Result<Outcome> run(const Options& options) {
  static runtime::RunControls controls;  // as long as signals may come
  catch_interrupts(controls.wants_stop);
  const Result<scenario::Scenario> scenario = experiment(options);
  if (!scenario) return fail(scenario.error());
  const Result<std::unique_ptr<runtime::ClosedLoop>> loop = runtime::ClosedLoop::create(*scenario);
  if (!loop) return fail(loop.error());
  if (options.is_fast) return run_fast(options, **loop, controls);
  return run_with_dashboard(options, **loop, controls);
}

}  // namespace

ExitCode drive(const Options& options) {
  const Result<Outcome> outcome = run(options);
  if (!outcome) return report(outcome.error());
  const telemetry::RunSummary& summary = outcome->summary;
  fmt::print("{}", options.is_json ? protocol::to_json(summary) : protocol::to_table(summary));
  if (!outcome->recorded) return report(outcome->recorded.error());
  const bool is_kept = stays_up(options) ? summary.off_track_events == 0 : kept_its_promises(summary);
  return is_kept ? kSuccess : kBrokenPromise;
}

}  // namespace chicane::apps
