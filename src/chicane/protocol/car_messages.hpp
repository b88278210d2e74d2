// SPDX-License-Identifier: MIT
// Messages that a controller and a car exchange as ROS 2 programs, and of which the topics of
// ros_messages.hpp consist: standard messages, our own StopPlan, and the parameter services of nodes. Bytes
// are CDR. Each message names its fields once, for both directions (detail/cdr_archive.hpp). Stamps are
// nanoseconds since 1970.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/vec2.hpp"
#include "chicane/model/state.hpp"
#include "chicane/protocol/detail/cdr_archive.hpp"
#include "chicane/protocol/foxglove_codec.hpp"
#include "chicane/safety/stop_player.hpp"

namespace chicane::protocol {

/// std_msgs/msg/Header.
void header_fields(auto& archive, auto& message) {
  archive.time(message.stamp);
  archive(message.frame);
}

/// nav_msgs/msg/Odometry.
struct OdometryMessage {
  static constexpr std::string_view kType = "nav_msgs/msg/Odometry";
  std::int64_t stamp = 0;
  std::string frame{};        ///< frame of the pose
  std::string child_frame{};  ///< frame of the motion
  model::Pose pose{};         ///< pose of the child frame
  double vx = 0.0;            ///< along the child frame's x axis [m/s]
  double vy = 0.0;            ///< along the child frame's y axis, left positive [m/s]
  double yaw_rate = 0.0;      ///< [rad/s]
  static void fields(auto& archive, auto& message) {
    header_fields(archive, message);
    archive(message.child_frame, message.pose);
    archive.zeros(36);
    archive(message.vx, message.vy);
    archive.zeros(3);
    archive(message.yaw_rate);
    archive.zeros(36);
  }
};

/// ackermann_msgs/msg/AckermannDriveStamped.
struct DriveMessage {
  static constexpr std::string_view kType = "ackermann_msgs/msg/AckermannDriveStamped";
  std::int64_t stamp = 0;
  std::string frame{};
  double steer = 0.0;         ///< road-wheel angle, left positive [rad]
  double speed = 0.0;         ///< requested speed [m/s]
  double acceleration = 0.0;  ///< requested acceleration [m/s²]
  static void fields(auto& archive, auto& message) {
    header_fields(archive, message);
    archive.template as<float>(message.steer);
    archive.constant(0.0F);
    archive.template as<float>(message.speed, message.acceleration);
    archive.constant(0.0F);
  }
};

/// autoware_control_msgs/msg/Control, with the content of a DriveMessage.
struct AutowareMessage {
  static constexpr std::string_view kType = "autoware_control_msgs/msg/Control";
  DriveMessage drive{};
  static void fields(auto& archive, auto& message) {
    const auto times = [&](int count) {
      for (int i = 0; i < count; ++i) archive.time(message.drive.stamp);
    };
    times(4);
    archive.template as<float>(message.drive.steer);
    archive.constant(0.0F, false);
    times(2);
    archive.template as<float>(message.drive.speed, message.drive.acceleration);
    archive.constant(0.0F, true, false);
  }
};

/// sensor_msgs/msg/Imu, of which a planar car has these fields.
struct ImuMessage {
  static constexpr std::string_view kType = "sensor_msgs/msg/Imu";
  std::int64_t stamp = 0;
  std::string frame{};
  double yaw_rate = 0.0;  ///< [rad/s]
  double ax = 0.0;        ///< forward acceleration [m/s²]
  double ay = 0.0;        ///< lateral acceleration, left positive [m/s²]
  static void fields(auto& archive, auto& message) {
    header_fields(archive, message);
    archive.constant(0.0, 0.0, 0.0, 1.0, -1.0);  // the first covariance is -1: there is no orientation
    archive.zeros(8 + 2);
    archive(message.yaw_rate);
    archive.zeros(9);
    archive(message.ax, message.ay);
    archive.zeros(1 + 9);
  }
};

/// geometry_msgs/msg/PoseStamped.
struct StampedPose {
  static constexpr std::size_t kSmallest = 64;  ///< least size in a list [byte]
  std::int64_t stamp = 0;
  std::string frame{};
  model::Pose pose{};
  static void fields(auto& archive, auto& message) {
    header_fields(archive, message);
    archive(message.pose);
  }
};

/// nav_msgs/msg/Path.
struct PathMessage {
  static constexpr std::string_view kType = "nav_msgs/msg/Path";
  static constexpr std::size_t kCapacity = 100'000;  ///< poses; longer paths are refused
  std::int64_t stamp = 0;
  std::string frame{};
  std::vector<StampedPose> poses{};
  static void fields(auto& archive, auto& message) {
    header_fields(archive, message);
    archive.list(message.poses, StampedPose::kSmallest, kCapacity,
                 [&](auto& each) { StampedPose::fields(archive, each); });
  }
  [[nodiscard]] bool is_sound() const {
    for (const StampedPose& each : poses)
      if (!std::isfinite(each.pose.x) || !std::isfinite(each.pose.y)) return false;
    return true;
  }
};
/// Poses along a polyline, each with the direction to the next point.
[[nodiscard]] PathMessage path_along(std::int64_t stamp, const std::string& frame,
                                     std::span<const Vec2> line);

/// geometry_msgs/msg/PoseWithCovarianceStamped.
struct PoseMessage {
  static constexpr std::string_view kType = "geometry_msgs/msg/PoseWithCovarianceStamped";
  std::int64_t stamp = 0;
  std::string frame{};
  model::Pose pose{};
  static void fields(auto& archive, auto& message) {
    StampedPose::fields(archive, message);
    archive.zeros(36);
  }
  [[nodiscard]] bool is_sound() const {
    return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.psi);
  }
};

/// sensor_msgs/msg/LaserScan.
struct ScanMessage {
  static constexpr std::string_view kType = "sensor_msgs/msg/LaserScan";
  static constexpr std::size_t kCapacity = 100'000;  ///< beams; longer scans are refused
  std::int64_t stamp = 0;
  std::string frame{};
  double angle_min = 0.0;        ///< angle from the frame's x axis to the first beam, left positive [rad]
  double angle_increment = 0.0;  ///< [rad]
  double scan_time = 0.0;        ///< time between scans [s]
  double range_min = 0.0;        ///< [m]
  double range_max = 0.0;        ///< [m]
  std::vector<float> ranges{};   ///< range of each beam [m]
  static void fields(auto& archive, auto& message) {
    header_fields(archive, message);
    archive.template as<float>(message.angle_min);
    const double beams = static_cast<double>(message.ranges.size()) - 1.0;
    archive.constant(static_cast<float>(message.angle_min + beams * message.angle_increment));
    archive.template as<float>(message.angle_increment);
    archive.constant(0.0F);
    archive.template as<float>(message.scan_time, message.range_min, message.range_max);
    archive.list(message.ranges, sizeof(float), kCapacity, [&](auto& range) { archive(range); });
    archive.constant(std::uint32_t{0});  // no intensities
  }
};

/// geometry_msgs/msg/TransformStamped, in the plane.
struct TransformMessage {
  static constexpr std::size_t kSmallest = 72;  ///< least size in a list [byte]
  std::int64_t stamp = 0;
  std::string frame{};
  std::string child_frame{};
  model::Pose pose{};  ///< pose of the child frame
  static void fields(auto& archive, auto& message) {
    header_fields(archive, message);
    archive(message.child_frame, message.pose);
  }
};

/// tf2_msgs/msg/TFMessage.
struct TransformsMessage {
  static constexpr std::string_view kType = "tf2_msgs/msg/TFMessage";
  static constexpr std::size_t kCapacity = 100'000;  ///< transforms; longer lists are refused
  std::vector<TransformMessage> transforms{};
  static void fields(auto& archive, auto& message) {
    archive.list(message.transforms, TransformMessage::kSmallest, kCapacity,
                 [&](auto& each) { TransformMessage::fields(archive, each); });
  }
};

/// rosgraph_msgs/msg/Clock.
struct ClockMessage {
  static constexpr std::string_view kType = "rosgraph_msgs/msg/Clock";
  std::int64_t time = 0;
  static void fields(auto& archive, auto& message) { archive.time(message.time); }
};

/// std_msgs/msg/Bool.
struct BoolMessage {
  static constexpr std::string_view kType = "std_msgs/msg/Bool";
  bool data = false;
  static void fields(auto& archive, auto& message) { archive(message.data); }
};

/// chicane_msgs/msg/StopPlan. Times of the plan are in seconds after the stamp.
struct StopMessage {
  static constexpr std::string_view kType = "chicane_msgs/msg/StopPlan";
  std::int64_t stamp = 0;  ///< stamp of the odometry that the command answers
  safety::StopPlan stop{};
};
template <>
[[nodiscard]] std::string encode(const StopMessage& message);
/// Decoded plan. None if a number is not finite or times decrease.
template <>
[[nodiscard]] std::optional<StopMessage> decode(std::string_view bytes);

// Requests and replies of the parameter services that every ROS 2 node has (rcl_interfaces/srv), as
// rmw_cyclonedds sends them: the ServiceCall comes before the content.

/// Identity of a request, which its reply repeats.
struct ServiceCall {
  std::uint64_t client = 0;   ///< number of the client
  std::int64_t sequence = 0;  ///< number of the request, by that client
};
void call_fields(auto& archive, auto& message) { archive(message.call.client, message.call.sequence); }
/// rcl_interfaces/msg/ParameterType of a parameter's value.
[[nodiscard]] std::uint8_t type_number(const foxglove::Parameter& parameter);
/// rcl_interfaces/msg/ParameterValue, and ParameterDescriptor.
void value_fields(WritingArchive& archive, const foxglove::Parameter& parameter);
void value_fields(ReadingArchive& archive, foxglove::Parameter& parameter);
void descriptor_fields(WritingArchive& archive, const foxglove::Parameter& parameter);

/// Limit of parameters in one message; chosen: bounds memory.
inline constexpr std::size_t kMostParameters = 100'000;

/// Requests of rcl_interfaces/srv/GetParameters, DescribeParameters and ListParameters, to which `names` are
/// prefixes. Bytes after the names are not read.
struct NamesRequest {
  ServiceCall call{};
  std::vector<std::string> names{};
  static void fields(auto& archive, auto& message) {
    call_fields(archive, message);
    archive(message.names);
    archive.trailing(std::uint64_t{0});
  }
};

/// Request of rcl_interfaces/srv/SetParameters. Numbers of any kind are double; arrays are read as not set.
struct SetRequest {
  ServiceCall call{};
  std::vector<foxglove::Parameter> parameters{};
  static void fields(auto& archive, auto& message) {
    call_fields(archive, message);
    archive.list(message.parameters, 40, kMostParameters, [&](auto& each) {
      archive(each.name);
      value_fields(archive, each);
    });
  }
};

/// Outcome for one parameter in the reply to SetParameters.
struct SetOutcome {
  bool is_successful = false;
  std::string reason{};  ///< reason of a refusal, a sentence
};
/// Reply to SetParameters.
struct SetReply {
  ServiceCall call{};
  std::vector<SetOutcome> outcomes{};
  static void fields(auto& archive, auto& message) {
    call_fields(archive, message);
    archive.list(message.outcomes, 5, kMostParameters,
                 [&](auto& each) { archive(each.is_successful, each.reason); });
  }
};

/// Reply to ListParameters.
struct ListReply {
  ServiceCall call{};
  std::vector<std::string> names{};
  static void fields(auto& archive, auto& message) {
    call_fields(archive, message);
    archive(message.names);
    archive.trailing(std::uint32_t{0});  // no prefixes
  }
};

/// Reply to GetParameters: values in the order of the request, without names; monostate for a name that no
/// parameter has. Tunables that are whole numbers are sent as integers.
struct GetReply {
  ServiceCall call{};
  std::vector<foxglove::Parameter> values{};
  static void fields(auto& archive, auto& message) {
    call_fields(archive, message);
    archive.list(message.values, 32, kMostParameters, [&](auto& each) { value_fields(archive, each); });
  }
};

/// Reply to DescribeParameters: type, meaning and range from the schema's table. Written only.
struct DescribeReply {
  ServiceCall call{};
  std::vector<foxglove::Parameter> values{};
  static void fields(auto& archive, auto& message) {
    call_fields(archive, message);
    archive.list(message.values, 32, kMostParameters, [&](auto& each) { descriptor_fields(archive, each); });
  }
};

}  // namespace chicane::protocol
