// SPDX-License-Identifier: MIT
// Message of a control step: its rows, from which definition, writer and reader are made.
#include "chicane/protocol/step_codec.hpp"

#include "chicane/protocol/detail/own_messages.hpp"

namespace chicane::protocol {
namespace {

/// Fields of the message.
struct StepMessage {
  Step step{};
  std::int8_t rung = 0;
  std::vector<double> waypoints{};  ///< x and y in turn
  model::Command manual{};
  bool is_manual = false;
};

void step_rows(auto& row, auto& message) {
  auto& step = message.step;
  auto& seen = step.measurement;
  row("cycle", "as in Frame", step.cycle);
  row("time", "of the measurement [s]", seen.time);
  row("x", "measured, world frame [m]", seen.x);
  row("y", "[m]", seen.y);
  row("psi", "yaw [rad], left positive", seen.psi);
  row("speed", "[m/s]", seen.speed);
  row("steer", "that acted before [rad], left positive", seen.steer);
  row("throttle", "that acted before [-1, 1]", seen.throttle);
  row("delay", "expected until the command acts [s]", seen.delay);
  row("command_steer", "sent [rad], left positive", step.command.steer);
  row("command_throttle", "sent [-1, 1]", step.command.throttle);
  row("step_time", "of the control step [s], wall clock", step.step_time);
  row("rung", "source of the command, as in Frame", message.rung);
  row("gated", "the command gate changed it", step.gated);
  row("waypoints", "x and y in turn, world frame [m]", message.waypoints);
  row("gate_interval", "since the command before [s]; 0 skips the rate limit", step.gate_interval);
  row("longest_interval", "the longest lately [s]", step.longest_interval);
  row("manual_steer", "a person's command, while is_manual [rad], left positive", message.manual.steer);
  row("manual_throttle", "[-1, 1]", message.manual.throttle);
  row("deadline_spent_at", "the solver's first question to the clock that was answered with \"late\"; 0 none",
      step.deadline_spent_at);
  row("begins", "controller and gate had forgotten everything", step.begins);
  row("has_measurement", "false: what came was unusable, the controller was not asked", step.has_measurement);
  row("is_manual", "a person drove", message.is_manual);
}

}  // namespace

std::string_view step_schema() {
  static const std::string schema = [] {
    DefinedRows rows("", 24);
    const StepMessage message;
    step_rows(rows, message);
    return rows.text();
  }();
  return schema;
}

std::string encode_step(const telemetry::Frame& frame) {
  const model::Measurement& seen = frame.measurement;
  StepMessage message{.step = {.cycle = frame.cycle,
                               .measurement = seen,
                               .command = frame.result.command,
                               .gated = frame.guard.gated,
                               .step_time = frame.step_time,
                               .begins = frame.begins,
                               .has_measurement = frame.has_measurement,
                               .gate_interval = frame.gate_interval,
                               .longest_interval = frame.longest_interval,
                               .deadline_spent_at = frame.deadline_spent_at},
                      .rung = static_cast<std::int8_t>(frame.guard.rung),
                      .manual = frame.manual,
                      .is_manual = frame.is_manual};
  for (std::size_t i = 0; i < static_cast<std::size_t>(seen.waypoint_count); ++i)
    message.waypoints.insert(message.waypoints.end(), {seen.waypoints[i].x(), seen.waypoints[i].y()});
  return written([&](auto& row) { step_rows(row, std::as_const(message)); });
}

std::optional<Step> decode_step(std::string_view bytes) {
  ReadRows rows(bytes);
  StepMessage message;
  step_rows(rows, message);
  Step& step = message.step;
  const std::vector<double>& waypoints = message.waypoints;
  if (!rows.is_at_end() || message.rung < 0 ||
      static_cast<std::size_t>(message.rung) >= controller::kRungCount || waypoints.size() % 2 != 0 ||
      waypoints.size() > 2 * model::Measurement::kMaxWaypoints)
    return std::nullopt;
  step.rung = static_cast<controller::Rung>(message.rung);
  step.measurement.waypoint_count = static_cast<int>(waypoints.size() / 2);
  for (std::size_t i = 0; i < waypoints.size() / 2; ++i) {
    step.measurement.waypoints[i].x() = waypoints[2 * i];
    step.measurement.waypoints[i].y() = waypoints[2 * i + 1];
  }
  if (message.is_manual) step.manual = message.manual;
  return step;
}

}  // namespace chicane::protocol
