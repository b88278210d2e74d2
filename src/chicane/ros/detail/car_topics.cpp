// SPDX-License-Identifier: MIT
#include "chicane/ros/detail/car_topics.hpp"

#include <string>
#include <string_view>
#include <utility>

#include "chicane/protocol/car_messages.hpp"

namespace chicane::ros {

std::vector<WantedPartner> wanted_partners(const NodeOptions& node) {
  std::vector<WantedPartner> wanted{{.topic = node.topics.odom,
                                     .type = std::string(protocol::OdometryMessage::kType),
                                     .qos = node.odom_qos,
                                     .qos_option = "--odom-qos",
                                     .topic_option = "--odom-topic"},
                                    {.is_reader = false,
                                     .topic = node.topics.drive,
                                     .type = std::string(protocol::DriveMessage::kType),
                                     .qos = node.drive_qos,
                                     .qos_option = "--drive-qos",
                                     .topic_option = "--drive-topic"}};
  if (node.is_time_simulated) {
    wanted.push_back({.topic = "/clock",
                      .type = std::string(protocol::kClockType),
                      .qos = {.is_reliable = false},
                      .qos_option = "",
                      .topic_option = ""});
  }
  if (!node.topics.path.empty()) {
    wanted.push_back({.topic = node.topics.path,
                      .type = std::string(protocol::PathMessage::kType),
                      .qos = {.is_reliable = false},
                      .qos_option = "",
                      .topic_option = "--path-topic"});
  }
  return wanted;
}

Result<CarTopics> CarTopics::create(Participant& at, const NodeOptions& node) {
  CarTopics topics;
  Result<void> made;
  const auto read = [&](std::unique_ptr<Reader>& to, const std::string& name, std::string_view type,
                        Qos qos) {
    if (name.empty() || !made) return;
    if (auto reader = at.reader(name, std::string(type), qos))
      to = std::move(*reader);
    else
      made = fail(reader.error());
  };
  const auto send = [&](std::unique_ptr<Writer>& to, const std::string& name, std::string_view type,
                        Qos qos) {
    if (name.empty() || !made) return;
    if (auto writer = at.writer(name, std::string(type), qos))
      to = std::move(*writer);
    else
      made = fail(writer.error());
  };
  const Qos any{.is_reliable = false};
  read(topics.odom, node.topics.odom, protocol::OdometryMessage::kType, node.odom_qos);
  read(topics.imu, node.topics.imu, protocol::ImuMessage::kType, any);
  read(topics.path, node.topics.path, protocol::PathMessage::kType, any);
  // One that was sent before, too: a volatile reader gets none of those, and a transient local one no
  // others.
  read(topics.kept_path, node.topics.path, protocol::PathMessage::kType,
       {.is_transient_local = true, .depth = 1});
  read(topics.transforms, "/tf", protocol::TransformMessage::kType, {.is_reliable = false, .depth = 100});
  read(topics.fixed_transforms, "/tf_static", protocol::TransformMessage::kType,
       {.is_transient_local = true, .depth = 100});
  if (node.is_time_simulated) read(topics.clock, "/clock", protocol::kClockType, any);
  read(topics.initial_pose, node.topics.initial_pose, protocol::PoseMessage::kType, {});
  read(topics.stop, node.topics.stop, protocol::kBoolType, {});
  send(topics.drive, node.topics.drive, protocol::DriveMessage::kType, node.drive_qos);
  send(topics.autoware, node.topics.autoware, protocol::DriveMessage::kAutowareType, node.drive_qos);
  send(topics.stop_plan, node.topics.stop_plan, protocol::StopMessage::kType, node.drive_qos);
  if (!made) return fail(made.error());
  return topics;
}

std::vector<int> CarTopics::matched() const {
  std::vector<int> matched{odom->matched(), drive ? drive->matched() : 0};
  if (clock) matched.push_back(clock->matched());
  if (path) matched.push_back(path->matched());
  return matched;
}

}  // namespace chicane::ros
