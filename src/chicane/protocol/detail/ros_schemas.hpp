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
/// @foxglove/rosmsg-msgs-common. Those of chicane_msgs are ours; chicane_msgs/Frame is not among them,
/// because it follows from its table (frame_fields.hpp).
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
    RosDefinition{"chicane_msgs/Plan",
                  R"(# What the controller intends: predicted motion of the centre of mass with
# its commands, all arrays of the same length; element 0 is where the first command acts.
builtin_interfaces/Time stamp
float64[] time_s
float64[] x_m
float64[] y_m
float64[] yaw_rad
float64[] speed_mps
float64[] steer_rad
float64[] throttle
)"},
    RosDefinition{"chicane_msgs/Run", R"(# What is running: constant until something is chosen anew.
string track
float64 track_length_m                  # 0 = unknown
bool is_closed
string controller
string preset
float64 latency_s                       # artificial, from command to actuation
float64 control_period_s
bool is_paused

# The car, as the controller models it
string car
float64 front_axle_m                    # centre of mass to front axle
float64 rear_axle_m                     # centre of mass to rear axle
float64 track_width_m                   # between the wheels of an axle
float64 tire_width_m
float64 body_length_m
float64 body_width_m
float64 steer_limit_rad

string mode                             # "drive": our simulator; "serve": an external one
string[] cost_term_names                # of Frame.cost_terms
string[] constraint_names               # of the bits of Frame.active_now and active_ahead, from the lowest
string[] fault_names                    # of the bits of Frame.active_faults
float64 kerb_width_m                    # drivable, outside each edge
string building                         # another run that is being built: "track = oval"; empty: none
string end                              # "finished", "stopped", "failed": the run is over; empty: it goes on
string end_reason                       # why, in one sentence; empty when it finished
string guard_mode                       # "on", "observe", "off"; empty: not known
string guard_road                       # where the guard knows the road from: "track", "waypoints"
uint32 guard_version                    # 0: not known
float64 brake_throttle_limit            # the throttle that brakes fully is minus this
string[] notices                        # what was assumed, and what has no effect: a sentence each

# Where car and road come from, as their files say it
string[] car_notes
string[] identified_keys                # parameters found by a log, in the unit of their key
float64[] identified_values
float64[] identified_low                # 95 % interval; not-a-number: assumed, the log did not excite it
float64[] identified_high
string track_kind                       # "occupancy map", "table of points"; empty: not known
string[] track_notes                    # remarks of the file, and what its reader assumed
float64 track_scale                     # the road's size over that of its file
uint32 track_points                     # in the file; 0: not known
float64 track_fit_rms_m                 # of the points from the smooth line
float64 track_fit_max_m
)"},
    RosDefinition{"chicane_msgs/Lap", R"(# One completed lap, sent when it is.
uint32 lap                              # its number, from 1
float64 lap_time_s
float64[3] sector_times_s               # thirds of the lap
bool is_clean                           # no tyre left the road
float64 mean_speed_mps
float64 top_speed_mps
float64 min_edge_distance_m             # of the outermost tyre, negative = off the road
float64 rms_lateral_error_m
float64 gap_to_limit_percent            # lap time over the limit's, minus 100 %; not-a-number while unknown
float64[3] sector_gaps_to_limit_percent # the same for the thirds
string[] setting_names                  # changed since the run began, as at the end of the lap
string[] setting_values                 # as --set takes them
bool is_mixed                           # one of them changed while the lap was driven
float64 by_hand_share                   # of its time, driven by a person
string[] faults                         # that acted in it
)"},
    RosDefinition{"chicane_msgs/Limit",
                  R"(# The physical limit of this road for this car: the fastest lap of the model
# in docs/limit.md and its line, arrays of the same length by rising time from the start
# line, the last point the first one again.
bool is_known                           # false: see why_not; the rest is empty
float64 lap_time_s
float64[3] sector_times_s               # thirds of the lap, from the start line
float64[] s_m                           # along the centre line from its beginning
float64[] x_m                           # of the centre of mass
float64[] y_m
float64[] n_m                           # to the left of the centre line
float64[] speed_mps
float64[] longitudinal_acceleration_mps2
float64[] lateral_acceleration_mps2     # positive to the left
float64[] time_s                        # since the start line
string why_not                          # in one sentence, while is_known is false
uint32 first_lap                        # it holds for laps from this one on: before, grip or mass were others
float64[] corner_times_s                # of the limit, in the order of a lap, with half of the straights beside
string[] without                        # laps that were driven again without these, one at a time: "latency"
float64[] without_lap_times_s           # the best of each; not-a-number where there was none
float64[] without_corner_times_s        # of these laps, one after the other; not-a-number where not known
)"},
    RosDefinition{"chicane_msgs/Change",
                  R"(# A setting that changed during the run, before this control cycle.
builtin_interfaces/Time stamp
uint64 cycle
string name                             # key as in YAML and --set: "latency_ms"
string value                            # as --set takes it
)"},
    RosDefinition{"chicane_msgs/StopPlan",
                  R"(# How the car comes to rest when no further command arrives. Sent before the
# command that it belongs to; columns have the same length.
builtin_interfaces/Time stamp           # of the odometry that the command answers
float64[] time_s                        # after the stamp, from which the command acts
float64[] distance_m                    # driven since the stop began
float64[] speed_mps                     # planned then
float64[] steer_rad                     # left positive
float64[] throttle                      # [-1, 1], negative brakes
)"},
};

}  // namespace chicane::protocol
