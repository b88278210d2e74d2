// SPDX-License-Identifier: MIT
// Message of a control step: its rows, from which definition, writer and reader are made.
#include "chicane/protocol/step_codec.hpp"

#include "chicane/protocol/detail/own_messages.hpp"

namespace chicane::protocol {
namespace {

constexpr int kMeaningColumn = 24;  // column at which meanings begin in the definition; chosen

/// Fields of the message. Differs from Step where a message has no such type.
struct StepMessage {
  Step step{};
  std::int8_t rung = 0;             ///< controller::Rung as a number
  std::vector<double> waypoints{};  ///< x and y in turn
  model::Command manual{};          ///< zero without a person's command
  bool is_manual = false;           ///< Step::manual has a value
};

/// Visits the fields in the order of their bytes: another order, or a field more, makes recordings
/// unreadable.
void step_rows(auto& row, auto& message) {
  auto& step = message.step;
  auto& seen = step.measurement;
  row("cycle", "number of the control cycle", step.cycle);
  row("time", "time of the measurement [s]", seen.time);
  row("x", "measured position, world frame [m]", seen.x);
  row("y", "measured position, world frame [m]", seen.y);
  row("psi", "measured yaw angle [rad], left positive", seen.psi);
  row("speed", "measured speed [m/s]", seen.speed);
  row("steer", "steering angle in effect at the measurement [rad], left positive", seen.steer);
  row("throttle", "throttle in effect at the measurement [-1, 1]", seen.throttle);
  row("delay", "expected delay from the measurement until the command acts [s]", seen.delay);
  row("command_steer", "sent steering angle [rad], left positive", step.command.steer);
  row("command_throttle", "sent throttle [-1, 1]", step.command.throttle);
  row("step_time", "duration of the control step [s], wall clock", step.step_time);
  row("rung", "source of the command: 0 the controller, others as rung of Frame", message.rung);
  row("gated", "whether the command gate changed the command", step.gated);
  row("waypoints", "measured waypoints, x and y in turn, world frame [m]", message.waypoints);
  row("gate_interval", "time since the previous command [s]; 0: its rate is not limited", step.gate_interval);
  row("longest_interval", "longest recent interval between commands [s]", step.longest_interval);
  row("manual_steer", "steering angle of a person, if is_manual [rad], left positive", message.manual.steer);
  row("manual_throttle", "throttle of a person, if is_manual [-1, 1]", message.manual.throttle);
  row("deadline_spent_at",
      "number of the clock reading at which the solver first found its deadline passed; 0: none",
      step.deadline_spent_at);
  row("begins", "whether controller and gate were reset before this step", step.begins);
  row("has_measurement", "false: the measurement was missing or unusable, the controller did not run",
      step.has_measurement);
  row("is_manual", "whether a person drove", message.is_manual);
}

}  // namespace

std::string_view step_schema() {
  static const std::string schema = [] {
    DefinedRows rows("", kMeaningColumn);
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

/// Checks each value that its type does not bound: the bytes may come from any program.
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
