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

/// The description of a type as it is hashed: JSON of type_description_interfaces/msg/TypeDescription without
/// default values, as in REP 2016. `schema`: protocol::ros_schema(type).
[[nodiscard]] std::string type_description(std::string_view type, std::string_view schema);
/// The hash that ROS 2 announces for a type from Iron on, "RIHS01_" and 64 hexadecimal digits: SHA-256 of
/// type_description(). Empty for a type whose definition is not known.
[[nodiscard]] std::string type_hash(std::string_view type);

}  // namespace chicane::ros

// Cyclone's.
struct ddsi_serdata;
struct ddsi_sertype;

namespace chicane::ros {

/// Type of Cyclone DDS whose samples are bytes, sent and received without change. The sample of dds_write()
/// is a std::string_view. Freed by Cyclone.
[[nodiscard]] ddsi_sertype* make_cdr_type(const std::string& name);
/// The bytes of a message of such a type, as long as it lives.
[[nodiscard]] std::string_view bytes_of(const ddsi_serdata& message);

}  // namespace chicane::ros
