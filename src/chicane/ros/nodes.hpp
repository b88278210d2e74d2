// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/protocol/ros_messages.hpp"
#include "chicane/ros/dds.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/sim/range_scanner.hpp"
#include "chicane/wire/serve.hpp"
#include "chicane/wire/simulate.hpp"

namespace chicane::ros {

/// Topics by name, as f1tenth_gym_ros has them. An empty name: not read, not sent.
struct TopicNames {
  std::string odom = "/ego_racecar/odom";        ///< nav_msgs/msg/Odometry, from the car
  std::string drive = "/drive";                  ///< ackermann_msgs/msg/AckermannDriveStamped, to the car
  std::string autoware{};                        ///< autoware_control_msgs/msg/Control, to the car
  std::string imu = "/imu";                      ///< sensor_msgs/msg/Imu, of the simulator
  std::string path{};                            ///< nav_msgs/msg/Path to follow; empty: the track is known
  std::string initial_pose = "/initialpose";     ///< geometry_msgs/msg/PoseWithCovarianceStamped
  std::string stop = "/chicane/stop";            ///< std_msgs/msg/Bool: true stops, false drives on
  std::string stop_plan = "/chicane/stop_plan";  ///< chicane_msgs/msg/StopPlan, to the car
  std::string scan = "/scan";                    ///< sensor_msgs/msg/LaserScan, of the simulator
};

/// Meaning of a drive message to the car.
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
  /// Origin of the odometry's child frame: the middle of the rear axle; false: the centre of mass.
  bool is_base_at_rear_axle = true;
  bool is_time_simulated = false;  ///< the controller's time is /clock's
  /// Seconds of the simulator in a second of the clock, > 0; it then sends /clock. 0: as many, without.
  double pace = 0.0;
  std::string map_file{};              ///< map that the simulated /scan sees; empty: the road's edges
  Qos odom_qos{.is_reliable = false};  ///< settings of the controller's reader; the simulator sends reliably
  Qos drive_qos{};                     ///< settings of its writer; the simulator reads best effort
};

/// The walls of an occupancy map (protocol/occupancy_map.hpp): cells darker than occupied_thresh; unknown
/// ones are free. Fails as protocol::read_map().
[[nodiscard]] Result<sim::OccupancyGrid> read_map(const std::string& file);

/// `chicane ros`: wire::serve for a car that speaks ROS 2. Reads odometry, answers each with a command, and
/// publishes the run (run_publisher.hpp). Dashboard, settings and recording are those of `serve`.
///
/// A control cycle begins with odometry, at most one each 0.75 control periods. If none comes in time the
/// cycle has no measurement, and the guard decides; after kAbsence without odometry cycles end until it
/// returns. TopicNames::stop makes the car execute its stop plan; it continues only from rest.
///
/// Uses of the options: track, lap, scenario, step_budget, forget_after, silent_after, server (dashboard).
/// kIo when DDS or the port fails.
[[nodiscard]] Result<wire::ServeSummary> drive(const NodeOptions& node, const wire::ServeOptions& options,
                                               std::unique_ptr<controller::Controller> controller,
                                               wire::ServeHooks hooks, wire::Endpoint* viewer,
                                               std::vector<net::Asset> assets, const std::atomic<bool>& stop);

/// `chicane ros --simulate`: our car and track as ROS 2 topics, in real time: odometry, transform, IMU and
/// laser scan out, drive commands in. The car waits for the first command. Each command acts
/// `scenario.latency` after it arrived. When they cease `scenario.guard.receiver` stops the car, by the last
/// command's stop plan if it had one.
///
/// Uses of the scenario: track, car, plant_options, vehicle, guard.receiver, sensor, seed, laps, time_limit,
/// latency, control_period (of the odometry). Ends when the laps are driven, the car is lost, time is up, or
/// `stop` is set, with the results so far.
[[nodiscard]] Result<wire::SimulateReport> simulate(const NodeOptions& node,
                                                    const scenario::Scenario& scenario,
                                                    const wire::SimulateHooks& hooks,
                                                    const std::atomic<bool>& stop);

}  // namespace chicane::ros
