// SPDX-License-Identifier: MIT
// The two ROS 2 nodes, controller and simulator, and their options.
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

/// Names of topics; defaults as in f1tenth_gym_ros. Topics with an empty name are neither read nor sent.
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
  /// Time in which the car's speed controller closes a gap of speed [s], (0, 5]. The speed that is sent is
  /// this time multiplied by the wanted acceleration above the current one. Default chosen.
  double speed_lead = 0.25;
};

/// Options of a ROS 2 node, controller or simulator.
struct NodeOptions {
  NetworkOptions network{};
  TopicNames topics{};
  protocol::FrameNames frames{.map = "map", .odom = "map", .base = "ego_racecar/base_link"};
  DriveOptions drive{};
  /// Origin of the odometry's child frame: the middle of the rear axle; false: the centre of mass.
  bool is_base_at_rear_axle = true;
  bool is_time_simulated = false;  ///< the controller's time is /clock's
  /// Simulated seconds per second of the clock, > 0; the simulator then sends /clock. 0: one, without /clock.
  double pace = 0.0;
  std::string map_file{};              ///< map that the simulated laser sees; empty: the edges of the road
  Qos odom_qos{.is_reliable = false};  ///< quality of the controller's reader; the simulator sends reliably
  Qos drive_qos{};  ///< quality of the controller's writer; the simulator reads best effort
};

/// Walls of an occupancy map (protocol/occupancy_map.hpp): cells darker than occupied_thresh; unknown cells
/// are free. Fails as protocol::read_map().
[[nodiscard]] Result<sim::OccupancyGrid> read_map(const std::string& file);

/// `chicane ros`: wire::serve for a car with ROS 2. Answers odometry with commands, and publishes the run
/// (run_publisher.hpp). Dashboard, settings and recording are those of `serve`.
///
/// Each odometry begins a control cycle, at most one in 0.75 control periods. If none comes in time, the
/// guard decides in a cycle without a measurement; after ten seconds without odometry, cycles end until it
/// returns. TopicNames::stop makes the car execute its stop plan; the car drives on only from rest.
///
/// Uses track, lap, scenario, step_budget, forget_after, silent_after and server of `options`. kIo when DDS
/// or the port fails.
[[nodiscard]] Result<wire::ServeSummary> drive(const NodeOptions& node, const wire::ServeOptions& options,
                                               std::unique_ptr<controller::Controller> controller,
                                               wire::ServeHooks hooks, wire::Endpoint* viewer,
                                               std::vector<net::Asset> assets, const std::atomic<bool>& stop);

/// `chicane ros --simulate`: our car and track as ROS 2 topics, in real time. Sends odometry, transforms, IMU
/// and laser scans; reads drive commands. The car waits for the first command. A command acts
/// `scenario.latency` after it arrived. When commands cease, `scenario.guard.receiver` stops the car, by the
/// stop plan of the last command if it had one.
///
/// Uses track, car, plant_options, vehicle, guard.receiver, sensor, seed, laps, time_limit, latency and
/// control_period (of the odometry) of the scenario. Ends, with the results so far, when the laps are driven,
/// the car is lost, the time is up, or `stop` is set.
[[nodiscard]] Result<wire::SimulateReport> simulate(const NodeOptions& node,
                                                    const scenario::Scenario& scenario,
                                                    const wire::SimulateHooks& hooks,
                                                    const std::atomic<bool>& stop);

}  // namespace chicane::ros
