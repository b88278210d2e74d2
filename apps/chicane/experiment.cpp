// SPDX-License-Identifier: MIT
#include "experiment.hpp"

#include "chicane/run/make.hpp"
#include "chicane/run/roads.hpp"

namespace chicane::apps {

protocol::Request request_of(const Options& options) {
  return {options.scenario_file, options.settings, options.speed_mps, options.faults, options.speed_mph};
}

Result<scenario::Scenario> experiment(const Options& options) {
  return protocol::compose(request_of(options));
}

Result<std::unique_ptr<run::ClosedLoop>> prepared(const protocol::Request& request) {
  const Result<scenario::Scenario> scenario = protocol::compose(request);
  if (!scenario) return fail(scenario.error());
  return run::ClosedLoop::create(*scenario);
}

Result<std::unique_ptr<run::ClosedLoop>> prepared(const scenario::Scenario& scenario,
                                                  const run::PlanHooks& hooks) {
  run::Roads roads;
  if (auto road = roads.of(scenario, run::make_track, hooks); !road) return fail(road.error());
  return run::ClosedLoop::create(scenario, roads);  // on that road, which it remembers
}

}  // namespace chicane::apps
