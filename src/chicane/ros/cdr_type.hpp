// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace chicane::ros {

/// Name of a ROS 2 topic in DDS: "/drive" is "rt/drive". Names without a slash in front, such as services',
/// stay the same.
[[nodiscard]] std::string dds_topic(std::string_view topic);
/// The name of a ROS 2 message type in DDS: "nav_msgs/msg/Odometry" is "nav_msgs::msg::dds_::Odometry_".
[[nodiscard]] std::string dds_type(std::string_view type);
/// The reverse of dds_topic(): "rt/drive" is "/drive". Names of other kinds stay as they are.
[[nodiscard]] std::string ros_topic(std::string_view topic);
/// The reverse of dds_type(). Names of other kinds stay as they are.
[[nodiscard]] std::string ros_type(std::string_view type);

}  // namespace chicane::ros

// Cyclone's.
struct ddsi_serdata;
struct ddsi_sertype;

namespace chicane::ros {

/// A message as dds_write() takes it of make_cdr_type().
struct OutgoingMessage {
  std::string_view bytes{};  ///< CDR with its header
  std::string_view call{};   ///< of a reply: its request's Sample::call; empty: none
};

/// Type of Cyclone DDS whose samples are bytes, sent and received without change. Freed by Cyclone.
[[nodiscard]] ddsi_sertype* make_cdr_type(const std::string& name);
/// Before the first message with a call is sent in the domain of `type`, of which a topic was made.
void let_messages_have_calls(const ddsi_sertype& type);
/// The bytes of a message of such a type, as long as it lives.
[[nodiscard]] std::string_view bytes_of(const ddsi_serdata& message);
/// Its Sample::call.
[[nodiscard]] std::string_view call_of(const ddsi_serdata& message);

}  // namespace chicane::ros
