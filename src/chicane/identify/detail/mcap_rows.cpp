// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/identify/detail/log_rows.hpp"
#include "chicane/protocol/car_messages.hpp"
#include "chicane/protocol/step_codec.hpp"
#include "chicane/telemetry/mcap_reader.hpp"

namespace chicane::identify {
namespace {

constexpr std::string_view kOdometry = protocol::OdometryMessage::kType;
constexpr std::string_view kDrive = protocol::DriveMessage::kType;

/// [s] after the first message; a message without a stamp counts when it was logged.
class Clock {
 public:
  double operator()(std::int64_t stamp, std::uint64_t log_time) {
    const std::int64_t now = stamp != 0 ? stamp : static_cast<std::int64_t>(log_time);
    if (!first_) first_ = now;
    return 1e-9 * static_cast<double>(now - *first_);
  }

 private:
  std::optional<std::int64_t> first_;
};

/// Chosen topics of the type, one of which has to be meant.
Result<std::string> topic_of(const std::set<std::string>& topics, const std::string& wanted,
                             std::string_view type, const char* option, const std::string& file) {
  if (!wanted.empty() && topics.contains(wanted)) return wanted;
  if (wanted.empty() && topics.size() == 1) return *topics.begin();
  std::string names;
  for (const std::string& topic : topics) names += (names.empty() ? "" : ", ") + printable(topic);
  if (topics.empty()) names = "none";
  return fail(ErrorCode::kParse, fmt::format("{}: got the topics {} of {}, expected one; name it by {}", file,
                                             names, type, option));
}

}  // namespace

Result<LogRows> read_mcap_rows(const std::string& file, const LogOptions& options) {
  LogRows own;
  std::map<std::string, std::vector<Sample>> samples;  // by topic
  std::map<std::string, std::vector<Told>> told;
  std::set<std::string> odometry, drive;
  Clock clock;
  telemetry::McapVisitor visitor;
  visitor.on_message = [&](const telemetry::McapMessage& message) {
    const std::string& topic = message.channel.topic;
    if (topic == protocol::kStepTopic && message.channel.type == protocol::kStepType) {
      const auto step = protocol::decode_step(message.bytes);
      if (!step) return;
      const model::Measurement& m = step->measurement;
      if (step->has_measurement)
        own.samples.push_back({.time = m.time, .x = m.x, .y = m.y, .psi = m.psi, .speed = m.speed});
      own.told.push_back({m.time, step->command.steer, step->command.throttle});
    } else if (message.channel.message_encoding == "cdr" && message.channel.type == kOdometry) {
      if (const auto odom = protocol::decode_odometry(message.bytes)) {
        odometry.insert(topic);
        samples[topic].push_back({clock(odom->stamp, message.log_time), odom->pose.x, odom->pose.y,
                                  odom->pose.psi, hypot(odom->vx, odom->vy), odom->yaw_rate});
      }
    } else if (message.channel.message_encoding == "cdr" && message.channel.type == kDrive) {
      if (const auto command = protocol::decode_drive(message.bytes)) {
        drive.insert(topic);
        told[topic].push_back({.time = clock(command->stamp, message.log_time), .steer = command->steer});
      }
    }
  };
  const auto read = telemetry::read_mcap(file, visitor);
  if (!read) return fail(read.error());
  if (!own.told.empty()) {
    own.is_centre_of_mass = true;
    return own;
  }
  const auto odom_topic = topic_of(odometry, options.odom_topic, kOdometry, "--odom-topic", file);
  if (!odom_topic) return fail(odom_topic.error());
  const auto drive_topic = topic_of(drive, options.drive_topic, kDrive, "--drive-topic", file);
  if (!drive_topic) return fail(drive_topic.error());
  return LogRows{samples[*odom_topic], told[*drive_topic], false};
}

}  // namespace chicane::identify
