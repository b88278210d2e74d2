// SPDX-License-Identifier: MIT
#include "chicane/ros/detail/car_topics.hpp"

#include "chicane/ros/dds.hpp"

#include <string>

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
                      .type = std::string(protocol::ClockMessage::kType),
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
  Endpoints endpoints{at};
  const Qos any{.is_reliable = false};
  endpoints.read(topics.odom, node.topics.odom, protocol::OdometryMessage::kType, node.odom_qos);
  endpoints.read(topics.imu, node.topics.imu, protocol::ImuMessage::kType, any);
  endpoints.read(topics.path, node.topics.path, protocol::PathMessage::kType, any);
  // One that was sent before, too: a volatile reader gets none of those, and a transient local one no
  // others.
  endpoints.read(topics.kept_path, node.topics.path, protocol::PathMessage::kType,
                 {.is_transient_local = true, .depth = 1});
  endpoints.read(topics.transforms, "/tf", protocol::TransformsMessage::kType,
                 {.is_reliable = false, .depth = 100});
  endpoints.read(topics.fixed_transforms, "/tf_static", protocol::TransformsMessage::kType,
                 {.is_transient_local = true, .depth = 100});
  if (node.is_time_simulated) endpoints.read(topics.clock, "/clock", protocol::ClockMessage::kType, any);
  endpoints.read(topics.initial_pose, node.topics.initial_pose, protocol::PoseMessage::kType, {});
  endpoints.read(topics.stop, node.topics.stop, protocol::BoolMessage::kType, {});
  endpoints.send(topics.drive, node.topics.drive, protocol::DriveMessage::kType, node.drive_qos);
  endpoints.send(topics.autoware, node.topics.autoware, protocol::AutowareMessage::kType, node.drive_qos);
  endpoints.send(topics.stop_plan, node.topics.stop_plan, protocol::StopMessage::kType, node.drive_qos);
  if (!endpoints.made()) return fail(endpoints.made().error());
  return topics;
}

std::vector<int> CarTopics::matched() const {
  std::vector<int> matched{odom->matched(), drive ? drive->matched() : 0};
  if (clock) matched.push_back(clock->matched());
  if (path) matched.push_back(path->matched());
  return matched;
}

}  // namespace chicane::ros
