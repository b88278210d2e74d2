// SPDX-License-Identifier: MIT
#include "chicane/protocol/step_codec.hpp"

#include <bit>

#include "chicane/telemetry/mcap.hpp"

namespace chicane::protocol {
namespace {

constexpr std::string_view kHeader{"\0\1\0\0", 4};  // XCDR1, little endian
// All fields lie where CDR would align them: eight-byte ones first, and two bytes of padding before the
// count.
constexpr std::string_view kSchema =
    "uint64 cycle             # as in Frame\n"
    "float64 time             # of the measurement [s]\n"
    "float64 x                # measured, world frame [m]\n"
    "float64 y                # [m]\n"
    "float64 psi              # yaw [rad], left positive\n"
    "float64 speed            # [m/s]\n"
    "float64 steer            # that acted before [rad], left positive\n"
    "float64 throttle         # that acted before [-1, 1]\n"
    "float64 delay            # expected until the command acts [s]\n"
    "float64 command_steer    # sent [rad], left positive\n"
    "float64 command_throttle # sent [-1, 1]\n"
    "float64 step_time        # of the control step [s], wall clock\n"
    "int8 rung                # source of the command, as in Frame\n"
    "bool gated               # the command gate changed it\n"
    "float64[] waypoints      # x and y in turn, world frame [m]\n"
    "float64 gate_interval    # since the command before [s]; 0 skips the rate limit\n"
    "float64 manual_steer     # a person's command, while is_manual [rad], left positive\n"
    "float64 manual_throttle  # [-1, 1]\n"
    "uint32 deadline_spent_at # the solver's first question to the clock that was answered with \"late\"; 0 "
    "none\n"
    "bool begins              # controller and gate had forgotten everything\n"
    "bool has_measurement     # false: what came was unusable, the controller was not asked\n"
    "bool is_manual           # a person drove\n";

}  // namespace

std::string_view step_schema() { return kSchema; }

std::string encode_step(const telemetry::Frame& frame) {
  const model::Measurement& seen = frame.measurement;
  const model::Command& command = frame.result.command;
  std::string bytes(kHeader);
  telemetry::mcap::Fields fields(bytes);
  const auto real = [&](double value) { fields.number(std::bit_cast<std::uint64_t>(value)); };
  fields.number(frame.cycle);
  for (const double value : {seen.time, seen.x, seen.y, seen.psi, seen.speed, seen.steer, seen.throttle,
                             seen.delay, command.steer, command.throttle, frame.step_time}) {
    real(value);
  }
  fields.number(static_cast<std::uint8_t>(frame.guard.rung));
  fields.number(static_cast<std::uint8_t>(frame.guard.gated)).number(std::uint16_t{0});
  fields.number(static_cast<std::uint32_t>(2 * seen.waypoint_count));
  for (int i = 0; i < seen.waypoint_count; ++i) {
    real(seen.waypoints[static_cast<std::size_t>(i)].x());
    real(seen.waypoints[static_cast<std::size_t>(i)].y());
  }
  real(frame.gate_interval);
  real(frame.manual.steer);
  real(frame.manual.throttle);
  fields.number(frame.deadline_spent_at);
  for (const bool flag : {frame.begins, frame.has_measurement, frame.is_manual}) {
    fields.number(static_cast<std::uint8_t>(flag));
  }
  return bytes;
}

std::optional<Step> decode_step(std::string_view bytes) {
  telemetry::mcap::FieldReader fields(bytes);
  if (fields.take(kHeader.size()) != kHeader) return std::nullopt;
  const auto real = [&] { return std::bit_cast<double>(fields.number<std::uint64_t>()); };
  Step step;
  step.cycle = fields.number<std::uint64_t>();
  model::Measurement& seen = step.measurement;
  for (double* value : {&seen.time, &seen.x, &seen.y, &seen.psi, &seen.speed, &seen.steer, &seen.throttle,
                        &seen.delay, &step.command.steer, &step.command.throttle, &step.step_time}) {
    *value = real();
  }
  const auto rung = fields.number<std::uint8_t>();
  step.rung = static_cast<controller::Rung>(rung);
  step.gated = fields.number<std::uint8_t>() != 0;
  static_cast<void>(fields.number<std::uint16_t>());
  const auto count = fields.number<std::uint32_t>();
  if (rung >= controller::kRungCount || count % 2 != 0 || count > 2 * model::Measurement::kMaxWaypoints)
    return std::nullopt;
  seen.waypoint_count = static_cast<int>(count / 2);
  for (std::size_t i = 0; i < count / 2; ++i) {
    seen.waypoints[i].x() = real();
    seen.waypoints[i].y() = real();
  }
  step.gate_interval = real();
  const model::Command manual{.steer = real(), .throttle = real()};
  step.deadline_spent_at = fields.number<std::uint32_t>();
  step.begins = fields.number<std::uint8_t>() != 0;
  step.has_measurement = fields.number<std::uint8_t>() != 0;
  if (fields.number<std::uint8_t>() != 0) step.manual = manual;
  if (fields.is_short() || !fields.rest().empty()) return std::nullopt;
  return step;
}

std::optional<telemetry::Change> decode_change(std::string_view bytes) {
  telemetry::mcap::FieldReader fields(bytes);
  if (fields.take(kHeader.size()) != kHeader) return std::nullopt;
  const auto text = [&]() -> std::string_view {
    const std::size_t odd = (bytes.size() - fields.rest().size()) % 4;  // lengths lie at multiples of four
    static_cast<void>(fields.take(odd == 0 ? 0 : 4 - odd));
    const std::string_view with_end = fields.text();
    return with_end.substr(0, with_end.empty() ? 0 : with_end.size() - 1);
  };
  telemetry::Change change;
  change.time = static_cast<double>(fields.number<std::uint32_t>());
  change.time += 1e-9 * static_cast<double>(fields.number<std::uint32_t>());
  change.cycle = fields.number<std::uint64_t>();
  const std::string_view name = text(), value = text();
  if (fields.is_short() || !decltype(change.name)::fits(name) || !decltype(change.value)::fits(value))
    return std::nullopt;
  change.name = name;
  change.value = value;
  return change;
}

}  // namespace chicane::protocol
