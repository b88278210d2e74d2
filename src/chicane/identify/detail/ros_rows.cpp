// SPDX-License-Identifier: MIT
#include "chicane/identify/detail/ros_rows.hpp"

#include <fmt/format.h>

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/car_messages.hpp"

namespace chicane::identify {
namespace {

constexpr std::string_view kOdometry = protocol::OdometryMessage::kType;
constexpr std::string_view kDrive = protocol::DriveMessage::kType;

/// The rows of the topic that is meant.
template <class Row>
Result<std::vector<Row>> chosen(const std::map<std::string, std::vector<Row>>& topics,
                                const std::string& wanted, std::string_view type, const char* option,
                                const std::string& file) {
  if (const auto named = topics.find(wanted); named != topics.end()) return named->second;
  if (wanted.empty() && topics.size() == 1) return topics.begin()->second;
  std::string names;
  for (const auto& [topic, rows] : topics) names += (names.empty() ? "" : ", ") + printable(topic);
  if (topics.empty()) names = "none";
  return fail(ErrorCode::kParse, fmt::format("{}: got the topics {} of {}, expected one; name it by {}", file,
                                             names, type, option));
}

}  // namespace

double RosRows::seconds(std::int64_t stamp, std::uint64_t log_time) {
  const std::int64_t now = stamp != 0 ? stamp : static_cast<std::int64_t>(log_time);
  if (!first_) first_ = now;
  return 1e-9 * static_cast<double>(now - *first_);
}

void RosRows::add(const std::string& topic, std::string_view type, std::string_view bytes,
                  std::uint64_t log_time) {
  if (type == kOdometry) {
    if (const auto odom = protocol::decode<protocol::OdometryMessage>(bytes))
      samples_[topic].push_back({seconds(odom->stamp, log_time), odom->pose.x, odom->pose.y, odom->pose.psi,
                                 hypot(odom->vx, odom->vy), odom->yaw_rate});
  } else if (type == kDrive) {
    if (const auto command = protocol::decode<protocol::DriveMessage>(bytes))
      commands_[topic].push_back({.time = seconds(command->stamp, log_time), .steer = command->steer});
  }
}

Result<LogRows> RosRows::rows(const std::string& file, const LogOptions& options) const {
  auto samples = chosen(samples_, options.odom_topic, kOdometry, "--odom-topic", file);
  if (!samples) return fail(samples.error());
  if (commands_.empty() && !options.needs_commands) return LogRows{std::move(*samples), {}, false};
  auto commands = chosen(commands_, options.drive_topic, kDrive, "--drive-topic", file);
  if (!commands) return fail(commands.error());
  return LogRows{std::move(*samples), std::move(*commands), false};
}

}  // namespace chicane::identify
