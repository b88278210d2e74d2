// SPDX-License-Identifier: MIT
#include "record.hpp"

#include <fmt/format.h>

#include <utility>

#include "chicane/protocol/fault_codec.hpp"

namespace chicane::apps {
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
  run.faults = protocol::fault_names();
  return run;
}

Result<std::unique_ptr<runtime::Recorder>> start_recorder(const Options& options, protocol::Run run,
                                                          const scenario::Scenario& scenario,
                                                          double step_budget) {
  if (options.record_file.empty()) return nullptr;
  return runtime::Recorder::create({.path = options.record_file,
                                    .run = std::move(run),
                                    .scenario = scenario,
                                    .is_compressed = options.is_compressed,
                                    .step_budget = step_budget,
                                    .may_wait = options.is_fast});
}

Result<void> finish_recorder(const Options& options, runtime::Recorder* recorder) {
  if (recorder == nullptr) return {};
  const Result<runtime::RecorderReport> report = recorder->finish();
  if (!report) return fail(report.error());
  fmt::print(stderr, "{}: recorded {} steps, {:.1f} MB\n", options.record_file, report->frames,
             1e-6 * static_cast<double>(report->bytes));
  if (report->left_out > 0)
    fmt::print(stderr, "{}: the disk was too slow for {} steps\n", options.record_file, report->left_out);
  return {};
}

}  // namespace chicane::apps
