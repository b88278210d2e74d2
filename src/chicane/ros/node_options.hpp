// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "chicane/protocol/ros_messages.hpp"
#include "chicane/ros/dds.hpp"

namespace chicane::ros {

/// Topics by name, as f1tenth_gym_ros has them. An empty name: not read, not sent.
struct TopicNames {
  std::string odom = "/ego_racecar/odom";        ///< nav_msgs/msg/Odometry, from the car
  std::string drive = "/drive";                  ///< ackermann_msgs/msg/AckermannDriveStamped, to the car
  std::string autoware{};                        ///< autoware_control_msgs/msg/Control, to the car
  std::string imu = "/imu";                      ///< sensor_msgs/msg/Imu, from the car
  std::string path{};                            ///< nav_msgs/msg/Path to follow; empty: the track is known
  std::string initial_pose = "/initialpose";     ///< geometry_msgs/msg/PoseWithCovarianceStamped
  std::string stop = "/chicane/stop";            ///< std_msgs/msg/Bool: true stops, false drives on
  std::string stop_plan = "/chicane/stop_plan";  ///< chicane_msgs/msg/StopPlan, to the car
  std::string scan = "/scan";                    ///< sensor_msgs/msg/LaserScan, of the simulator
};

/// What a drive message means to the car.
struct DriveOptions {
  bool is_by_speed = true;  ///< the car holds `speed`; false: it takes `acceleration`
  /// The car's own speed controller closes a gap of speed in about this time [s], (0, 5]: the speed that is
  /// sent is the wanted acceleration times this ahead.
  double speed_lead = 0.25;
};

/// One ROS 2 program of ours, controller or simulator.
struct NodeOptions {
  NetworkOptions network{};
  TopicNames topics{};
  protocol::FrameNames frames{.map = "map", .odom = "map", .base = "ego_racecar/base_link"};
  DriveOptions drive{};
  /// Of the odometry's child frame: the middle of the rear axle; false: the centre of mass.
  bool is_base_at_rear_axle = true;
  bool is_time_simulated = false;  ///< the controller's time is that of /clock
  /// Seconds of the simulator in a second of the clock, > 0; it then sends /clock. 0: as many, without.
  double pace = 0.0;
  std::string map_file{};  ///< of the simulator: /scan sees this occupancy map; empty: the road's edges
  Qos odom_qos{.is_reliable = false};  ///< of the controller's reader; the simulator sends reliably
  Qos drive_qos{};                     ///< of the controller's writer; the simulator reads best effort
};

}  // namespace chicane::ros
