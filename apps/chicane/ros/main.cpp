// SPDX-License-Identifier: MIT
// The program chicane-ros, which runs the command `chicane ros`: the only program that needs DDS.
#include <fmt/format.h>

#include <atomic>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "chicane/protocol/json_report.hpp"
#include "chicane/ros/nodes.hpp"
#include "chicane/run/make.hpp"
#include "cmd_serve.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "options.hpp"
#include "program.hpp"

namespace chicane::apps {

namespace {

std::atomic<bool> ros_stop{false};  // set by signals; static, because it must outlive the last signal

/// Sentence about what helps a stopped car of ROS 2 (telemetry::SituationTerms).
constexpr std::string_view kPoseRemedy = "Send the pose on /initialpose, or drive there by hand";

/// Options of the node by the command line.
ros::NodeOptions node_of(const Options& options) {
  const Options::Ros& given = options.ros;
  ros::NodeOptions node;
  node.network = {.domain = given.domain, .interface = given.interface, .peers = given.peers};
  node.topics.odom = given.odom_topic;
  node.topics.drive = given.drive_topic;
  node.topics.autoware = given.autoware_topic;
  node.topics.path = given.path_topic;
  node.topics.imu = given.imu_topic;
  node.frames = {.map = given.map_frame, .odom = given.map_frame, .base = given.base_frame};
  node.is_time_simulated = given.is_time_simulated;
  node.pace = given.pace;
  node.map_file = given.map_file;
  node.drive = {.is_by_speed = given.drive_by == "speed", .speed_lead = given.speed_lead};
  node.is_base_at_rear_axle = given.base_at == "rear-axle";
  node.odom_qos.is_reliable = given.odom_qos == "reliable";
  node.drive_qos.is_reliable = given.drive_qos == "reliable";
  return node;
}

/// Options with the car f1tenth, whose names the topics have, unless an option names a car.
Options with_car(Options options) {
  if (!has_setting(options, "car")) options.settings.insert(options.settings.begin(), {"car", "f1tenth"});
  return options;
}

/// Checks names of topics: "/", then parts of letters, digits and underscores, separated by "/".
Result<void> check_topics(const ros::TopicNames& topics) {
  for (const auto& [option, topic] :
       {std::pair{"--odom-topic", &topics.odom}, std::pair{"--drive-topic", &topics.drive},
        std::pair{"--autoware-topic", &topics.autoware}, std::pair{"--path-topic", &topics.path},
        std::pair{"--imu-topic", &topics.imu}}) {
    const bool is_sound =
        topic->empty() ||
        (topic->size() > 1 && topic->front() == '/' && topic->back() != '/' &&
         topic->find("//") == std::string::npos &&
         topic->find_first_not_of("abcdefghijklmnopqrstuvwxyz"
                                  "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_/") == std::string::npos);
    if (!is_sound)
      return fail(ErrorCode::kInvalidArgument,
                  fmt::format("{}: got \"{}\", expected a topic like \"/odom\"", option, *topic));
  }
  return {};
}

/// Drives another program's car with the controller.
Result<wire::ServeSummary> drive_until_stopped(const Options& options, const ros::NodeOptions& node) {
  Result<scenario::Scenario> scenario = experiment(options);
  if (!scenario) return fail(scenario.error());
  std::optional<road::Track> track;
  if (node.topics.path.empty()) {
    Result<road::Track> made = run::make_track(*scenario);
    if (!made) return fail(made.error());
    track = std::move(*made);
  }
  return drive_external_car(
      options, std::move(*scenario), std::move(track),
      [&node](std::uint16_t) {
        return fmt::format("{} in DDS domain {}", node.topics.odom, node.network.domain);
      },
      ros_stop,
      [&node](wire::ServeOptions serving, auto&&... rest) {
        serving.remedy = kPoseRemedy;
        return ros::drive(node, serving, std::forward<decltype(rest)>(rest)...);
      });
}

/// Runs the controller as a node.
ExitCode drive_node(const Options& options, const ros::NodeOptions& node) {
  const Result<wire::ServeSummary> summary = drive_until_stopped(options, node);
  if (!summary) return report(summary.error());
  return print(options, *summary, "commands", "cars");
}

/// Runs the simulator as a node.
ExitCode simulate_node(const Options& options, const ros::NodeOptions& node) {
  const Result<wire::SimulateReport> done = drive_by_external(
      options,
      {.wants_limit = false,
       .on_start =
           [&](const scenario::Scenario& scenario, const road::Track& track) {
             return fmt::format("{} on {} waits for {} in DDS domain {} (Ctrl-C ends)", scenario.car,
                                track.name(), node.topics.drive, node.network.domain);
           }},
      ros_stop,
      [&](const scenario::Scenario& scenario, const road::Track&, const wire::SimulateHooks& hooks) {
        return ros::simulate(node, scenario, hooks, ros_stop);
      });
  if (!done) return report(done.error());
  fmt::print("{}", options.is_json ? protocol::to_json(done->run) : protocol::to_table(done->run));
  fmt::print(stderr, "{} commands of {} senders; {} broken, {} times stopped without one\n", done->answers,
             done->connections, done->broken_answers, done->stops);
  return completed_on_road(done->run) ? kSuccess : kRunFailed;
}

}  // namespace

/// Runs the controller as a ROS 2 node, or the simulator for one.
ExitCode ros_node(const Options& given) {
  if (given.ros.is_simulator) catch_interrupts(ros_stop);
  const Options options = with_car(given);
  const ros::NodeOptions node = node_of(options);
  if (const Result<void> sound = check_topics(node.topics); !sound) return report(sound.error());
  return options.ros.is_simulator ? simulate_node(options, node) : drive_node(options, node);
}

}  // namespace chicane::apps

int main(int count, char** words) {
  return chicane::apps::program_of("ros", count, words, chicane::apps::ros_node);
}
