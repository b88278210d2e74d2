// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/sim/world.hpp"
#include "chicane/telemetry/frame.hpp"

namespace chicane::run {

/// Writes a judge's findings into a frame: place, laps. The rest stays.
inline void observe(const sim::WorldState& state, telemetry::Frame& frame) noexcept {
  frame.is_judged = true;
  frame.s = state.s;
  frame.lateral_error = state.lateral_error;
  frame.heading_error = state.heading_error;
  frame.edge_distance = state.edge_distance;
  frame.is_off_track = state.is_off_track;
  frame.lap = state.lap;
  frame.lap_time = state.lap_time;
  frame.last_lap_time = state.last_lap_time;
  frame.off_track_events = state.off_track_events;
}

/// Writes the world's state into a frame: truth, accelerations, place, laps. The rest stays.
inline void observe(const sim::World& world, telemetry::Frame& frame) noexcept {
  frame.truth = world.plant().state();
  frame.has_truth = true;
  frame.lateral_acceleration = world.plant().output().ay;
  frame.longitudinal_acceleration = world.plant().output().ax;
  frame.tire_use = world.plant().output().tire_use;
  observe(world.state(), frame);
}

}  // namespace chicane::run
