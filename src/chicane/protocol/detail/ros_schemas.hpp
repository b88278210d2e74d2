// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

namespace chicane::protocol {

/// Definition of one message type in ROS 2's .msg language, with none of the definitions it refers to.
struct RosDefinition {
  std::string_view name;  ///< "nav_msgs/Odometry"
  std::string_view text;
};

/// Fields of the standard types as in ROS 2 Jazzy (common_interfaces 5.3, rcl_interfaces 2.0, geometry2 0.36,
/// ackermann_msgs 2.0, autoware_msgs 1.2), comments shortened; web/src/protocol/schemas.test.ts compares them
/// with
/// @foxglove/rosmsg-msgs-common. Those of chicane_msgs follow from their rows (own_messages.hpp).
inline constexpr std::array kRosDefinitions{
    RosDefinition{"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    RosDefinition{"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    RosDefinition{"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    RosDefinition{"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    RosDefinition{"geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"},
    RosDefinition{"geometry_msgs/Pose",
                  "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    RosDefinition{"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
    RosDefinition{"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
    RosDefinition{"geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
    RosDefinition{"geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
    RosDefinition{"geometry_msgs/Transform",
                  "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
    RosDefinition{"geometry_msgs/TransformStamped",
                  "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
    RosDefinition{"nav_msgs/Odometry",
                  "# Pose in header.frame_id, twist in child_frame_id.\n"
                  "std_msgs/Header header\nstring child_frame_id\n"
                  "geometry_msgs/PoseWithCovariance pose\ngeometry_msgs/TwistWithCovariance twist\n"},
    RosDefinition{"nav_msgs/Path", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n"},
    RosDefinition{"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    RosDefinition{"diagnostic_msgs/KeyValue", "string key\nstring value\n"},
    RosDefinition{"diagnostic_msgs/DiagnosticStatus",
                  "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\n"
                  "byte level\nstring name\nstring message\nstring hardware_id\n"
                  "diagnostic_msgs/KeyValue[] values\n"},
    RosDefinition{"diagnostic_msgs/DiagnosticArray",
                  "std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status\n"},
    RosDefinition{"rosgraph_msgs/Clock", "builtin_interfaces/Time clock\n"},
    RosDefinition{"ackermann_msgs/AckermannDrive",
                  "float32 steering_angle\nfloat32 steering_angle_velocity\nfloat32 speed\n"
                  "float32 acceleration\nfloat32 jerk\n"},
    RosDefinition{"ackermann_msgs/AckermannDriveStamped",
                  "std_msgs/Header header\nackermann_msgs/AckermannDrive drive\n"},
    RosDefinition{"geometry_msgs/PoseWithCovarianceStamped",
                  "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n"},
    RosDefinition{"sensor_msgs/Imu",
                  "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
                  "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
                  "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
                  "float64[9] linear_acceleration_covariance\n"},
    RosDefinition{"sensor_msgs/LaserScan",
                  "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\n"
                  "float32 angle_increment\nfloat32 time_increment\nfloat32 scan_time\n"
                  "float32 range_min\nfloat32 range_max\nfloat32[] ranges\nfloat32[] intensities\n"},
    RosDefinition{"std_msgs/Bool", "bool data\n"},
    RosDefinition{"autoware_control_msgs/Lateral",
                  "builtin_interfaces/Time stamp\nbuiltin_interfaces/Time control_time\n"
                  "float32 steering_tire_angle\nfloat32 steering_tire_rotation_rate\n"
                  "bool is_defined_steering_tire_rotation_rate\n"},
    RosDefinition{"autoware_control_msgs/Longitudinal",
                  "builtin_interfaces/Time stamp\nbuiltin_interfaces/Time control_time\n"
                  "float32 velocity\nfloat32 acceleration\nfloat32 jerk\n"
                  "bool is_defined_acceleration\nbool is_defined_jerk\n"},
    RosDefinition{"autoware_control_msgs/Control",
                  "builtin_interfaces/Time stamp\nbuiltin_interfaces/Time control_time\n"
                  "autoware_control_msgs/Lateral lateral\n"
                  "autoware_control_msgs/Longitudinal longitudinal\n"},
    RosDefinition{"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
    RosDefinition{"foxglove_msgs/Color", "float64 r\nfloat64 g\nfloat64 b\nfloat64 a\n"},
    RosDefinition{"foxglove_msgs/KeyValuePair", "string key\nstring value\n"},
    RosDefinition{"foxglove_msgs/ArrowPrimitive",
                  "geometry_msgs/Pose pose\nfloat64 shaft_length\nfloat64 shaft_diameter\n"
                  "float64 head_length\nfloat64 head_diameter\nfoxglove_msgs/Color color\n"},
    RosDefinition{"foxglove_msgs/CubePrimitive",
                  "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 size\nfoxglove_msgs/Color color\n"},
    RosDefinition{"foxglove_msgs/SpherePrimitive",
                  "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 size\nfoxglove_msgs/Color color\n"},
    RosDefinition{"foxglove_msgs/CylinderPrimitive",
                  "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 size\nfloat64 bottom_scale\n"
                  "float64 top_scale\nfoxglove_msgs/Color color\n"},
    RosDefinition{"foxglove_msgs/LinePrimitive",
                  "uint8 LINE_STRIP=0\nuint8 LINE_LOOP=1\nuint8 LINE_LIST=2\nuint8 type\n"
                  "geometry_msgs/Pose pose\nfloat64 thickness\nbool scale_invariant\n"
                  "geometry_msgs/Point[] points\nfoxglove_msgs/Color color\n"
                  "foxglove_msgs/Color[] colors\nuint32[] indices\n"},
    RosDefinition{"foxglove_msgs/TriangleListPrimitive",
                  "geometry_msgs/Pose pose\ngeometry_msgs/Point[] points\nfoxglove_msgs/Color color\n"
                  "foxglove_msgs/Color[] colors\nuint32[] indices\n"},
    RosDefinition{"foxglove_msgs/TextPrimitive",
                  "geometry_msgs/Pose pose\nbool billboard\nfloat64 font_size\nbool scale_invariant\n"
                  "foxglove_msgs/Color color\nstring text\n"},
    RosDefinition{"foxglove_msgs/ModelPrimitive",
                  "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nfoxglove_msgs/Color color\n"
                  "bool override_color\nstring url\nstring media_type\nuint8[] data\n"},
    RosDefinition{"foxglove_msgs/SceneEntityDeletion",
                  "uint8 MATCHING_ID=0\nuint8 ALL=1\nbuiltin_interfaces/Time timestamp\nuint8 type\n"
                  "string id\n"},
    RosDefinition{"foxglove_msgs/SceneEntity",
                  "builtin_interfaces/Time timestamp\nstring frame_id\nstring id\n"
                  "builtin_interfaces/Duration lifetime\nbool frame_locked\n"
                  "foxglove_msgs/KeyValuePair[] metadata\nfoxglove_msgs/ArrowPrimitive[] arrows\n"
                  "foxglove_msgs/CubePrimitive[] cubes\nfoxglove_msgs/SpherePrimitive[] spheres\n"
                  "foxglove_msgs/CylinderPrimitive[] cylinders\nfoxglove_msgs/LinePrimitive[] lines\n"
                  "foxglove_msgs/TriangleListPrimitive[] triangles\nfoxglove_msgs/TextPrimitive[] texts\n"
                  "foxglove_msgs/ModelPrimitive[] models\n"},
    RosDefinition{"foxglove_msgs/SceneUpdate",
                  "foxglove_msgs/SceneEntityDeletion[] deletions\nfoxglove_msgs/SceneEntity[] entities\n"},
};

}  // namespace chicane::protocol
