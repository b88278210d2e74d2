// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/vec2.hpp"
#include "chicane/model/state.hpp"
#include "chicane/safety/stop_plan.hpp"

/// Messages that a controller and a car exchange as ROS 2 programs, beside the topics of ros_messages.hpp.
/// CDR as there; bytes that are no such message are read as none. Stamps are nanoseconds since 1970.
namespace chicane::protocol {

/// nav_msgs/msg/Odometry.
struct OdometryMessage {
  static constexpr std::string_view kType = "nav_msgs/msg/Odometry";
  std::int64_t stamp = 0;
  std::string frame{};        ///< of the pose
  std::string child_frame{};  ///< of the motion
  model::Pose pose{};         ///< of the child frame
  double vx = 0.0;            ///< along the child frame [m/s]
  double vy = 0.0;            ///< across it, left positive [m/s]
  double yaw_rate = 0.0;      ///< [rad/s]
};
[[nodiscard]] std::string encode(const OdometryMessage& message);
[[nodiscard]] std::optional<OdometryMessage> decode_odometry(std::string_view bytes);

/// ackermann_msgs/msg/AckermannDriveStamped, and autoware_control_msgs/msg/Control with the same content.
struct DriveMessage {
  static constexpr std::string_view kType = "ackermann_msgs/msg/AckermannDriveStamped";
  static constexpr std::string_view kAutowareType = "autoware_control_msgs/msg/Control";
  std::int64_t stamp = 0;
  std::string frame{};
  double steer = 0.0;         ///< road-wheel angle, left positive [rad]
  double speed = 0.0;         ///< wanted [m/s]
  double acceleration = 0.0;  ///< wanted [m/s²]
};
[[nodiscard]] std::string encode(const DriveMessage& message);
[[nodiscard]] std::string encode_autoware(const DriveMessage& message);
[[nodiscard]] std::optional<DriveMessage> decode_drive(std::string_view bytes);

/// sensor_msgs/msg/Imu, the part that a planar car has.
struct ImuMessage {
  static constexpr std::string_view kType = "sensor_msgs/msg/Imu";
  std::int64_t stamp = 0;
  std::string frame{};
  double yaw_rate = 0.0;  ///< [rad/s]
  double ax = 0.0;        ///< [m/s²]
  double ay = 0.0;        ///< left positive [m/s²]
};
[[nodiscard]] std::string encode(const ImuMessage& message);
[[nodiscard]] std::optional<ImuMessage> decode_imu(std::string_view bytes);

/// nav_msgs/msg/Path, positions only.
struct PathMessage {
  static constexpr std::string_view kType = "nav_msgs/msg/Path";
  static constexpr std::size_t kCapacity = 100'000;  ///< points; longer paths are refused
  std::int64_t stamp = 0;
  std::string frame{};
  std::vector<Vec2> points{};
};
[[nodiscard]] std::string encode(const PathMessage& message);
[[nodiscard]] std::optional<PathMessage> decode_path(std::string_view bytes);

/// geometry_msgs/msg/PoseWithCovarianceStamped.
struct PoseMessage {
  static constexpr std::string_view kType = "geometry_msgs/msg/PoseWithCovarianceStamped";
  std::int64_t stamp = 0;
  std::string frame{};
  model::Pose pose{};
};
[[nodiscard]] std::string encode(const PoseMessage& message);
[[nodiscard]] std::optional<PoseMessage> decode_pose(std::string_view bytes);

/// sensor_msgs/msg/LaserScan.
struct ScanMessage {
  static constexpr std::string_view kType = "sensor_msgs/msg/LaserScan";
  std::int64_t stamp = 0;
  std::string frame{};
  double angle_min = 0.0;        ///< of the first beam from the frame's x axis, left positive [rad]
  double angle_increment = 0.0;  ///< [rad]
  double scan_time = 0.0;        ///< between scans [s]
  double range_min = 0.0;        ///< [m]
  double range_max = 0.0;        ///< [m]
  std::vector<float> ranges{};   ///< [m]
};
[[nodiscard]] std::string encode(const ScanMessage& message);

/// tf2_msgs/msg/TFMessage with one transform in the plane.
struct TransformMessage {
  static constexpr std::string_view kType = "tf2_msgs/msg/TFMessage";
  std::int64_t stamp = 0;
  std::string frame{};
  std::string child_frame{};
  model::Pose pose{};  ///< of the child frame
};
[[nodiscard]] std::string encode(const TransformMessage& message);
/// All transforms of a message.
[[nodiscard]] std::optional<std::vector<TransformMessage>> decode_transforms(std::string_view bytes);

/// chicane_msgs/msg/StopPlan: times of the plan are [s] after the stamp.
struct StopMessage {
  static constexpr std::string_view kType = "chicane_msgs/msg/StopPlan";
  std::int64_t stamp = 0;  ///< of the odometry that the command answers
  safety::StopPlan stop{};
};
[[nodiscard]] std::string encode(const StopMessage& message);
/// None also for a plan with numbers that are not finite, or with times that decrease.
[[nodiscard]] std::optional<StopMessage> decode_stop(std::string_view bytes);

inline constexpr std::string_view kClockType = "rosgraph_msgs/msg/Clock";
[[nodiscard]] std::string encode_clock(std::int64_t time);
[[nodiscard]] std::optional<std::int64_t> decode_clock(std::string_view bytes);

inline constexpr std::string_view kBoolType = "std_msgs/msg/Bool";
[[nodiscard]] std::string encode_bool(bool value);
[[nodiscard]] std::optional<bool> decode_bool(std::string_view bytes);

}  // namespace chicane::protocol
