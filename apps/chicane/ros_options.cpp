// SPDX-License-Identifier: MIT
#include "ros_options.hpp"

#include <CLI/CLI.hpp>
#include <string>

namespace chicane::apps {
namespace {

void add_topic(CLI::App& command, const char* name, std::string& to, const char* help) {
  command.add_option(name, to, help)->type_name("TOPIC")->capture_default_str();
}

}  // namespace

void add_ros_network(CLI::App& command, Options& options) {
  Options::Ros& ros = options.ros;
  command.add_flag("--simulate", ros.is_simulator,
                   "Be the car and its simulator, for a controller that is a ROS 2 program");
  command.add_option("--domain", ros.domain, "DDS domain, as ROS_DOMAIN_ID, which is the default")
      ->type_name("N")
      ->check(CLI::Range(0, 232))
      ->envname("ROS_DOMAIN_ID");
  command
      .add_option("--interface", ros.interface,
                  "Network interface of DDS: lo reaches this machine alone, auto takes the best")
      ->type_name("NAME")
      ->capture_default_str();
  command
      .add_option("--peer", ros.peers, "Address of a partner, where there is no multicast; may be repeated")
      ->type_name("ADDRESS")
      ->allow_extra_args(false);
  add_topic(command, "--odom-topic", ros.odom_topic, "Odometry of the car");
  add_topic(command, "--drive-topic", ros.drive_topic, "Commands as AckermannDriveStamped");
  add_topic(command, "--autoware-topic", ros.autoware_topic, "Commands as Autoware's Control, too");
  add_topic(command, "--path-topic", ros.path_topic, "Follow a nav_msgs/Path in place of a track");
  add_topic(command, "--imu-topic", ros.imu_topic, "IMU: its yaw rate is compared with the odometry's");
  command.add_option("--map-frame", ros.map_frame, "Frame of the odometry's pose")
      ->type_name("FRAME")
      ->capture_default_str();
  command.add_option("--base-frame", ros.base_frame, "Frame of the car")
      ->type_name("FRAME")
      ->capture_default_str();
  command
      .add_option("--base-at", ros.base_at,
                  "Place of the car's frame: in the middle of the rear axle, or in the "
                  "centre of mass")
      ->check(CLI::IsMember({"rear-axle", "centre-of-mass"}))
      ->capture_default_str();
  CLI::Option* const simulates = command.get_option("--simulate");
  command
      .add_flag("--use-sim-time", ros.is_time_simulated,
                "Count time by /clock, as a simulator sends it, in place of this machine's")
      ->excludes(simulates);
  command
      .add_option("--pace", ros.pace,
                  "Seconds of the simulator in a second of the clock, with --simulate; sends /clock")
      ->type_name("X")
      ->check(CLI::Range(0.05, 20.0))
      ->needs(simulates);
  command
      .add_option("--map", ros.map_file,
                  "Occupancy map whose walls /scan sees, with --simulate, as map_server reads it, in "
                  "place of the track's edges")
      ->type_name("FILE.yaml")
      ->needs(simulates);
  command.add_option("--drive-by", ros.drive_by, "Part of a drive message that the car follows")
      ->check(CLI::IsMember({"speed", "acceleration"}))
      ->capture_default_str();
  command
      .add_option("--speed-lead-s", ros.speed_lead,
                  "Time in which the car's speed controller closes a gap, with --drive-by speed [s]")
      ->type_name("X")
      ->check(CLI::Range(0.02, 5.0))
      ->capture_default_str();
  for (const auto& [name, to] :
       {std::pair{"--odom-qos", &ros.odom_qos}, std::pair{"--drive-qos", &ros.drive_qos}}) {
    command.add_option(name, *to, "Reliability of the controller's end of this topic")
        ->check(CLI::IsMember({"best-effort", "reliable"}))
        ->capture_default_str();
  }
}

}  // namespace chicane::apps
