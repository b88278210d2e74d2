// SPDX-License-Identifier: MIT
// Names of ROS 2 topics and types in DDS, and the type of Cyclone DDS whose samples are bytes.
#pragma once

#include <string>
#include <string_view>

namespace chicane::ros {

/// Name of a ROS 2 topic in DDS: "rt/drive" for "/drive". Names without a slash in front, as those of
/// services, stay the same.
[[nodiscard]] std::string dds_topic(std::string_view topic);
/// Name of a ROS 2 message type in DDS: "nav_msgs::msg::dds_::Odometry_" for "nav_msgs/msg/Odometry".
[[nodiscard]] std::string dds_type(std::string_view type);
/// Name of a DDS topic in ROS 2: "/drive" for "rt/drive". Names of other kinds stay the same.
[[nodiscard]] std::string ros_topic(std::string_view topic);
/// Name of a DDS type in ROS 2. Names of other kinds stay the same.
[[nodiscard]] std::string ros_type(std::string_view type);

}  // namespace chicane::ros

// Types of Cyclone DDS: a message, and a type of messages.
struct ddsi_serdata;
struct ddsi_sertype;

namespace chicane::ros {

/// Message that dds_write() takes for a type by make_cdr_type().
struct OutgoingMessage {
  std::string_view bytes{};  ///< CDR with its header
  std::string_view call{};   ///< Sample::call of the request that this reply answers; empty: no reply
};

/// Makes a type of Cyclone DDS whose samples are bytes, sent and received without change. Freed by Cyclone.
[[nodiscard]] ddsi_sertype* make_cdr_type(const std::string& name);
/// Enables replies with a call in the domain of `type`. Call it before the first such reply is sent, and
/// after a topic of `type` was made.
void let_messages_have_calls(const ddsi_sertype& type);
/// Bytes of a message of such a type; valid as long as the message.
[[nodiscard]] std::string_view bytes_of(const ddsi_serdata& message);
/// Sample::call of a message of such a type.
[[nodiscard]] std::string_view call_of(const ddsi_serdata& message);

}  // namespace chicane::ros
