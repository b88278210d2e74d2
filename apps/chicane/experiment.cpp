// SPDX-License-Identifier: MIT
#include "experiment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "chicane/protocol/fault_codec.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/schema.hpp"

namespace chicane::apps {

Result<scenario::Scenario> experiment(const Options& options) {
  Result<scenario::Scenario> scenario = protocol::compose({options.scenario_file, options.settings});
  if (!scenario) return scenario;
  for (const std::string& text : options.faults) {
    const Result<sim::FaultEvent> event = protocol::parse_fault(text);
    if (!event) return fail(event.error());
    scenario->faults.push_back(*event);
  }
  if (options.speed_mps.empty()) return scenario;
  std::string group = scenario->controller;
  std::replace(group.begin(), group.end(), '-', '_');
  const bool has_limit = group == "tracking_mpc";  // plans its own speed below a limit
  const std::string key = fmt::format("{}.{}", group, has_limit ? "speed_limit_mps" : "speed_reference_mps");
  const Result<void> done = protocol::set_text(*scenario, key, options.speed_mps);
  if (!done) return fail(done.error());
  return scenario;
}

}  // namespace chicane::apps
