// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/protocol/ros_messages.hpp"

namespace chicane::protocol::samples {

/// A frame with a different value in each field, so that no two can be exchanged unnoticed.
inline telemetry::Frame frame() {
  telemetry::Frame frame;
  frame.cycle = 1234567890123ULL;
  frame.time = 12.25;
  frame.has_truth = true;
  frame.is_judged = true;
  frame.truth = {.x = 10.0, .y = -20.0, .psi = 0.5, .vx = 30.0, .vy = -0.4, .r = 0.25, .steer = 0.03};
  frame.measurement = {.time = 12.25, .x = 10.1, .y = -20.2, .psi = 0.51, .speed = 29.5};
  controller::Plan& plan = frame.result.plan;
  plan.size = 3;
  for (int i = 0; i < plan.size; ++i) {
    const double step = i;
    plan.points[static_cast<std::size_t>(i)] = {.time = 12.375 + 0.0625 * step,
                                                .x = 11.0 + step,
                                                .y = -19.0 + 0.5 * step,
                                                .psi = 0.5 + 0.125 * step,
                                                .speed = 31.0 - step,
                                                .command = {0.01 * (step + 1.0), 0.5 - 0.25 * step}};
  }
  plan.reference_size = 2;
  plan.reference[0] = {1.0, 2.0};
  plan.reference[1] = {1.0, 5.0};
  controller::StepReport& report = frame.result.report;
  report.solve.status = solver::SolveStatus::kBudgetSpent;
  report.solve.iterations = 7;
  report.solve.sweeps = 9;
  report.solve.cost = 123.5;
  frame.guard.rung = controller::Rung::kShiftedPlan;
  report.lateral_error = 0.31;
  report.heading_error = -0.02;
  report.speed_reference = 33.0;
  report.delay = 0.118;
  report.sight = 140.0;
  report.has_map = true;
  frame.guard.gated = true;
  report.solve.stationarity = 0.0009765625;
  report.solve.violation = 0.0625;
  report.solve.worst_stage = 17;
  report.solve.worst_constraint = 4;
  report.explanation.cost_terms = {0.5, 1.5, 121.5};
  report.explanation.cost_term_count = 3;
  report.explanation.speed_limiter = controller::SpeedLimiter::kBraking;
  report.explanation.speed_limit = 34.5;
  report.explanation.active_now = 1U << 1U;
  report.explanation.active_ahead = 0b101010;
  frame.asked = {0.02, 0.75};
  frame.result.command = {0.01, 0.625};
  frame.is_manual = true;
  frame.tire_use = {0.875, 1.0625};
  frame.prediction_error = 0.03125;
  frame.result.report.learned = {
      .delay = {0.0625, 0.004}, .gain = {0.95, 0.02}, .offset = {-0.03, 0.002}, .grip = {0.85, 0.01}};
  frame.pace = 0.25;
  frame.active_faults = 0b100100;
  frame.applied = {0.015, -0.5};
  frame.step_time = 0.000456;
  frame.lateral_acceleration = 7.5;
  frame.longitudinal_acceleration = -1.25;
  frame.s = 456.5;
  frame.lateral_error = 0.3;
  frame.heading_error = -0.03;
  frame.edge_distance = 1.875;
  frame.is_off_track = true;
  frame.lap = 2;
  frame.lap_time = 4.5;
  frame.last_lap_time = 28.125;
  frame.off_track_events = 3;
  frame.completed_lap = {.lap = 2,
                         .lap_time = 28.125,
                         .sector_times = {9.25, 9.5, 9.375},
                         .is_clean = true,
                         .mean_speed = 47.5,
                         .top_speed = 49.25,
                         .min_edge_distance = 1.625,
                         .rms_lateral_error = 0.1875};
  frame.situation = telemetry::situation_of(frame, {}, {});
  return frame;
}

inline Run run() {
  Run run;
  run.track = "lakeside";
  run.track_length = 1350.5;
  run.controller = "tracking-mpc";
  run.preset = "default";
  run.latency = 0.1;
  run.control_period = 0.04;
  run.vehicle.rear_axle = 2.0;
  run.mode = "serve";
  run.cost_terms = {"lateral", "heading", "speed"};
  run.constraints = {"steer_limit", "throttle_max"};
  run.faults = {"link_lost", "half_grip"};
  run.lap_setup = {.names = {"latency_ms"},
                   .values = {"60"},
                   .is_mixed = true,
                   .by_hand_share = 0.25,
                   .faults = {"half_grip"}};
  run.kerb_width = 0.75;
  run.road.left = {{0.0, 2.0}, {4.0, 2.0}, {0.0, 2.0}};
  run.road.right = {{0.0, -2.0}, {4.0, -2.0}, {0.0, -2.0}};
  run.road.centre = {{0.0, 0.0}, {4.0, 0.0}, {0.0, 0.0}};
  run.building = "track = oval";
  run.end = "failed";
  run.end_reason = "time limit reached";
  run.notices = {"pid.speed_reference_mps: has no effect"};
  run.origin = {.car_notes = {"a car, identified from 60 s of log.csv"},
                .identified = {{"mass_kg", 3.5, 3.25, 3.75}, {"friction", 1.25, 1.0, 1.5}},
                .road_kind = "GPX",
                .road_notes = {"width: assumed"}};
  run.track_scale = 0.125;
  run.track_points = 321;
  run.track_fit = {.rms = 0.0625, .most = 0.1875};
  run.guard = {.mode = "observe", .road = "waypoints", .version = 7};
  lap_time::Limit limit;
  limit.times = {.lap = 25.0, .sectors = {8.0, 9.5, 7.5}, .corners = {9.0, 16.0}};
  limit.line = {{.s = 258.0, .d = 0.5, .position = {1.0, 2.0}, .speed = 40.0, .lateral_acceleration = -3.0},
                {.s = 260.0, .time = 0.0625, .d = 0.75, .position = {3.0, 2.25}, .speed = 40.5}};
  limit.line[1].longitudinal_acceleration = 4.5;
  run.limit = {.found = std::make_shared<const lap_time::Limit>(limit)};
  run.limit.without = {{.cause = "latency", .lap_time = 27.5, .corners = {10.25, 17.25}}, {.cause = "guard"}};
  return run;
}

inline std::string change() { return encode_change(12.25, 306, "latency_ms", "150"); }

}  // namespace chicane::protocol::samples
