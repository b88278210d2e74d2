// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/sim/world.hpp"
#include "chicane/telemetry/frame.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::run {

/// Writes what a judge says of the car into a frame: place, laps. The rest stays.
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

/// Writes what the world knows of the car into a frame: truth, accelerations, place, laps. The rest stays.
inline void observe(const sim::World& world, telemetry::Frame& frame) noexcept {
  frame.truth = world.plant().state();
  frame.has_truth = true;
  frame.lateral_acceleration = world.plant().output().ay;
  frame.longitudinal_acceleration = world.plant().output().ax;
  frame.tire_use = world.plant().output().tire_use;
  observe(world.state(), frame);
}

/// The lap that has just been timed, as metrics have measured it.
[[nodiscard]] inline telemetry::CompletedLap completed_lap(const sim::WorldState& world,
                                                           const telemetry::LapSummary& measured) noexcept {
  return {.lap = world.lap,
          .lap_time = measured.lap_time,
          .sector_times = measured.sector_times,
          .is_clean = world.last_lap_was_clean,
          .mean_speed = measured.mean_speed,
          .top_speed = measured.top_speed,
          .min_edge_distance = measured.min_edge_distance,
          .rms_lateral_error = measured.rms_lateral_error};
}

/// What metrics count of the physics step just done.
[[nodiscard]] inline telemetry::PhysicsSample physics_sample(const sim::World& world) noexcept {
  return {.step = world.plant().step_length(),
          .state = world.plant().state(),
          .lateral_acceleration = world.plant().output().ay,
          .lateral_error = world.state().lateral_error,
          .edge_distance = world.state().edge_distance,
          .is_off_track = world.state().is_off_track};
}

}  // namespace chicane::run
