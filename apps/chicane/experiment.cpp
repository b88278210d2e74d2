// SPDX-License-Identifier: MIT
#include "experiment.hpp"

#include <fmt/format.h>

#include "chicane/base/text.hpp"
#include "chicane/controller/registry.hpp"
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
  const auto* driver = controller::Registry::find(scenario->controller);
  if (driver->speed_option.empty()) {
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("--speed-mps: got {}, expected none: {} has no speed to set",
                            printable(options.speed_mps), driver->name));
  }
  const protocol::Parameter* row = protocol::find_option(driver->name, driver->speed_option);
  const Result<void> done = protocol::set_text(*scenario, row->key, options.speed_mps);
  if (!done) return fail(done.error());
  return scenario;
}

}  // namespace chicane::apps
