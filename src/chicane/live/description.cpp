// SPDX-License-Identifier: MIT
#include "chicane/live/description.hpp"

#include "chicane/protocol/schema_json.hpp"

namespace chicane::live {

void describe(const road::Track& track, protocol::Run& run) {
  constexpr double kRoadSpacing = 2.0;  // [m] between the drawn points of the road
  run.track = track.name();
  run.track_length = track.centre().length();
  run.is_closed = track.centre().is_closed();
  run.kerb_width = track.kerb_width();
  run.track_points = track.raw_points().size();
  run.track_fit = road::point_fit(track);
  run.road = protocol::road_lines(track, kRoadSpacing * run.vehicle.scale);
}

void describe(const scenario::Scenario& scenario, protocol::Run& run) {
  run.vehicle = scenario.vehicle;
  run.notices = scenario.notices;
  run.origin = protocol::origin_of(scenario);
  run.track_scale = scenario.size_of_track();
}

protocol::Run description(const run::ClosedLoop& loop) {
  const scenario::Scenario& scenario = loop.scenario();
  protocol::Run run;
  run.preset = scenario.preset;
  run.latency = scenario.latency;
  run.control_period = scenario.control_period;
  run.mode = "drive";
  run.guard = protocol::guard_facts(scenario.guard);
  describe(scenario, run);
  describe(loop.track(), run);
  protocol::describe(loop.controller(), run);
  run.faults = protocol::fault_names();
  return run;
}

}  // namespace chicane::live
