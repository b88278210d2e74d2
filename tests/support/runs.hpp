// SPDX-License-Identifier: MIT

#pragma once

#include "chicane/protocol/library.hpp"
#include "chicane/run/closed_loop.hpp"
#include "support/chicane_test.hpp"

namespace chicane::test {

using Settings = std::vector<std::pair<std::string, std::string>>;

/// What the program makes of these settings, by schema key; of one given twice the last.
inline scenario::Scenario scenario_of(const Settings& settings = {}) {
  const Result<scenario::Scenario> scenario = protocol::compose({.scenario_file = {}, .settings = settings});
  EXPECT_TRUE(scenario) << (scenario ? "" : scenario.error().message);
  return scenario.value_or(scenario::Scenario{});
}

inline std::unique_ptr<run::ClosedLoop> loop_of(const scenario::Scenario& scenario) {
  return *good(run::ClosedLoop::create(scenario));
}

/// Control cycles, one after another, each told by its frame.
template <class Told>
void drive_cycles(run::ClosedLoop& loop, int cycles, const Told& told, double budget = 0.0) {
  for (int done = 0; done < cycles;) {
    if (!loop.advance(budget)) continue;
    ++done;
    told(loop.frame());
  }
}

/// What `chicane drive --fast` reports.
inline telemetry::RunSummary drive(const scenario::Scenario& scenario) {
  return run::run_closed_loop(*loop_of(scenario));
}

}  // namespace chicane::test
