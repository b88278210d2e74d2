// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <atomic>
#include <memory>

#include "chicane/protocol/json_report.hpp"
#include "chicane/runtime/closed_loop.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "interrupt.hpp"
#include "progress.hpp"

namespace chicane::apps {
namespace {

Result<telemetry::RunSummary> run(const Options& options, const std::atomic<bool>& stop) {
  const Result<scenario::Scenario> scenario = experiment(options);
  if (!scenario) return fail(scenario.error());
  const Result<std::unique_ptr<runtime::ClosedLoop>> loop = runtime::ClosedLoop::create(*scenario);
  if (!loop) return fail(loop.error());
  Progress progress;
  return runtime::run_closed_loop(
      **loop, [&](const telemetry::Frame& frame) { progress.show(frame); }, [&] { return stop.load(); });
}

}  // namespace

ExitCode drive(const Options& options) {
  const Result<telemetry::RunSummary> summary = run(options, catch_interrupts());
  if (!summary) return report(summary.error());
  fmt::print("{}", options.is_json ? protocol::to_json(*summary) : protocol::to_table(*summary));
  return kept_its_promises(*summary) ? kSuccess : kBrokenPromise;
}

}  // namespace chicane::apps
