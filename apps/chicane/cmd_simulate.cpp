// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <atomic>

#include "chicane/protocol/json_report.hpp"
#include "commands.hpp"
#include "external_run.hpp"
#include "interrupt.hpp"

namespace chicane::apps {
namespace {

Result<wire::SimulateReport> connect_and_drive(const Options& options) {
  static std::atomic<bool> stop{false};  // as long as signals may come
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

ExitCode simulate(const Options& options) {
  const Result<wire::SimulateReport> done = connect_and_drive(options);
  if (!done) return report(done.error());
  fmt::print("{}", options.is_json ? protocol::to_json(done->run) : protocol::to_table(done->run));
  fmt::print(stderr, "{} answers in {} connections; {} broken, {} unasked for, {} missing\n", done->answers,
             done->connections, done->broken_answers, done->extra_answers, done->silences);
  return completed_on_road(done->run) ? kSuccess : kRunFailed;
}

}  // namespace chicane::apps
