// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <atomic>

#include "chicane/protocol/json_report.hpp"
#include "chicane/runtime/simulate.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "interrupt.hpp"
#include "progress.hpp"

namespace chicane::apps {
namespace {

Result<runtime::SimulateReport> run(const Options& options) {
  static std::atomic<bool> stop{false};  // as long as signals may come
  catch_interrupts(stop);
  const Result<scenario::Scenario> scenario = experiment(options);
  if (!scenario) return fail(scenario.error());
  runtime::SimulateOptions simulating;
  simulating.url = options.connect;
  simulating.server_command = options.server;
  Progress progress;
  return runtime::simulate(simulating, *scenario,
                           {.on_frame = [&](const telemetry::Frame& frame) { progress.show(frame); },
                            .log = [&](std::string_view line) { progress.say(line); }},
                           stop);
}

}  // namespace

ExitCode simulate(const Options& options) {
  const Result<runtime::SimulateReport> done = run(options);
  if (!done) return report(done.error());
  fmt::print("{}", options.is_json ? protocol::to_json(done->run) : protocol::to_table(done->run));
  fmt::print(stderr, "{} answers in {} connections; {} broken, {} unasked for, {} missing\n", done->answers,
             done->connections, done->broken_answers, done->extra_answers, done->silences);
  return kept_its_promises(done->run) ? kSuccess : kBrokenPromise;
}

}  // namespace chicane::apps
