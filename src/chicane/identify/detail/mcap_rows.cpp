// SPDX-License-Identifier: MIT
#include "chicane/identify/detail/ros_rows.hpp"
#include "chicane/protocol/step_codec.hpp"
#include "chicane/telemetry/mcap.hpp"

namespace chicane::identify {

Result<LogRows> read_mcap_rows(const std::string& file, const LogOptions& options) {
  LogRows own;
  RosRows foreign;
  telemetry::McapVisitor visitor;
  visitor.on_message = [&](const telemetry::McapMessage& message) {
    const telemetry::McapChannel& channel = message.channel;
    if (channel.topic == protocol::kStepTopic && channel.type == protocol::kStepType) {
      const auto step = protocol::decode_step(message.bytes);
      if (!step) return;
      const model::Measurement& m = step->measurement;
      if (step->has_measurement)
        own.samples.push_back({.time = m.time, .x = m.x, .y = m.y, .psi = m.psi, .speed = m.speed});
      own.commands.push_back({m.time, step->command.steer, step->command.throttle});
    } else if (channel.message_encoding == "cdr") {
      foreign.add(channel.topic, channel.type, message.bytes, message.log_time);
    }
  };
  const auto read = telemetry::read_mcap(file, visitor);
  if (!read) return fail(read.error());
  if (own.commands.empty()) return foreign.rows(file, options);
  own.is_centre_of_mass = true;
  return own;
}

}  // namespace chicane::identify
