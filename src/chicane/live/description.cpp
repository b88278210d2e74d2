// SPDX-License-Identifier: MIT
#include "chicane/live/description.hpp"

#include "chicane/protocol/fault_codec.hpp"

namespace chicane::live {

void describe(const path::Track& track, protocol::Run& run) {
  constexpr double kRoadSpacing = 2.0;  // [m] between the drawn points of the road
  run.track = track.name();
  run.track_length = track.centre().length();
  run.is_closed = track.centre().is_closed();
  run.kerb_width = track.kerb_width();
  run.road = protocol::road_lines(track, kRoadSpacing * run.vehicle.scale);
}

protocol::Run description(const run::ClosedLoop& loop) {
  const scenario::Scenario& scenario = loop.scenario();
  protocol::Run run;
  run.preset = scenario.preset;
  run.latency = scenario.latency;
  run.control_period = scenario.control_period;
  run.vehicle = scenario.vehicle;
  run.mode = "drive";
  run.guard = protocol::guard_facts(scenario.guard);
  describe(loop.track(), run);
  run.notices = scenario.notices;
  protocol::describe(loop.controller(), run);
  run.faults = protocol::fault_names();
  return run;
}

}  // namespace chicane::live
