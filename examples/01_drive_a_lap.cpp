// SPDX-License-Identifier: MIT
// Drives one lap of a shipped track with the default controller, in virtual time, and prints what it was
// like.

// [drive]
#include <cstdio>

#include "chicane/protocol/json_report.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/run/closed_loop.hpp"

int main() {
  using namespace chicane;
  const auto scenario = protocol::compose({.scenario_file = "first-lap", .settings = {{"laps", "1"}}});
  const auto loop = scenario.and_then([](const auto& lap) { return run::ClosedLoop::create(lap); });
  if (!loop) return std::puts(loop.error().message.c_str()), 2;
  const telemetry::RunSummary run = run::run_closed_loop(**loop);
  std::fputs(protocol::to_table(run).c_str(), stdout);
  return telemetry::completed_on_road(run) ? 0 : 1;
}
// [/drive]
