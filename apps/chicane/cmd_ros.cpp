// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "access.hpp"
#include "chicane/live/assets.hpp"
#include "chicane/live/description.hpp"
#include "chicane/live/run_limit.hpp"
#include "chicane/live/served_run.hpp"
#include "chicane/protocol/json_report.hpp"
#include "chicane/ros/drive_node.hpp"
#include "chicane/ros/sim_node.hpp"
#include "chicane/run/make.hpp"
#include "chicane/run/racing.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "guard_notice.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "record.hpp"

namespace chicane::apps {
namespace {

std::atomic<bool> ros_stop{false};  // set by signals, whose handler outlives each run

ros::NodeOptions node_of(const Options& options) {
  const Options::Ros& told = options.ros;
  ros::NodeOptions node;
  node.network = {.domain = told.domain, .interface = told.interface, .peers = told.peers};
  node.topics.odom = told.odom_topic;
  node.topics.drive = told.drive_topic;
  node.topics.autoware = told.autoware_topic;
  node.topics.path = told.path_topic;
  node.topics.imu = told.imu_topic;
  node.frames = {.map = told.map_frame, .odom = told.map_frame, .base = told.base_frame};
  node.drive = {.is_by_speed = told.drive_by == "speed", .speed_lead = told.speed_lead};
  node.is_base_at_rear_axle = told.base_at == "rear-axle";
  node.odom_qos.is_reliable = told.odom_qos == "reliable";
  node.drive_qos.is_reliable = told.drive_qos == "reliable";
  return node;
}

/// The F1TENTH car, whose names the topics have, where neither a scenario nor an option chooses another.
Options with_car(Options options) {
  const bool is_told = std::any_of(options.settings.begin(), options.settings.end(),
                                   [](const auto& setting) { return setting.first == "car"; });
  if (!is_told) options.settings.insert(options.settings.begin(), {"car", "f1tenth"});
  return options;
}

/// A topic is "/" and names of letters, digits and underscores.
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

Result<wire::ServeSummary> drive_until_stopped(const Options& options, const ros::NodeOptions& node) {
  Result<scenario::Scenario> scenario = experiment(options);
  if (!scenario) return fail(scenario.error());
  Result<std::unique_ptr<controller::Controller>> controller = run::make_controller(*scenario);
  if (!controller) return fail(controller.error());
  std::optional<path::Track> track;
  if (node.topics.path.empty()) {
    Result<path::Track> made = run::make_track(*scenario);
    if (!made) return fail(made.error());
    track = std::move(*made);
  } else {
    scenario->guard.road = safety::GuardRoad::kWaypoints;
  }
  const Result<net::ServerOptions> server = server_options(options);
  if (!server) return fail(server.error());
  auto planned = run::plan_lap(*scenario, track ? &*track : nullptr);
  if (!planned) return fail(planned.error());
  live::ServedRun served(*server, *scenario, std::move(*controller), std::move(track),
                         live::embedded_assets(), std::move(*planned));
  const auto kept = KeptRun::start(options, served.description(), *scenario, served.step_budget());
  if (!kept) return fail(kept.error());
  print_guard_notice(options, scenario->guard);
  Progress progress;
  auto summary = served.run(
      (*kept)->recorder(),
      {.on_frame = [&](const telemetry::Frame& frame) { progress.show(frame); },
       .on_lap = [&](const telemetry::CompletedLap& lap) { progress.say(line_of(lap)); },
       .say = [&](std::string_view line) { progress.say(line); }},
      [&](std::uint16_t port) {
        progress.say(fmt::format("{} ({}) waits for {} in DDS domain {}; dashboard at {} (Ctrl-C ends)",
                                 scenario->preset, scenario->controller, node.topics.odom,
                                 node.network.domain, link(*server, port)));
      },
      ros_stop,
      [&node](const wire::ServeOptions& serving, std::unique_ptr<controller::Controller> driver,
              wire::ServeHooks hooks, wire::Endpoint* viewer, std::vector<net::Asset> assets,
              const std::atomic<bool>& stop) {
        return ros::drive(node, serving, std::move(driver), std::move(hooks), viewer, std::move(assets),
                          stop);
      });
  if (const Result<void> done = (*kept)->finish(); summary && !done) return fail(done.error());
  return summary;
}

ExitCode drive_node(const Options& options, const ros::NodeOptions& node) {
  const Result<wire::ServeSummary> summary = drive_until_stopped(options, node);
  if (!summary) return report(summary.error());
  fmt::print(stderr, "{} commands to {} cars; {} unusable messages, {} commands changed by the gate\n",
             summary->answers, summary->connections, summary->unusable, summary->interventions);
  fmt::print("{}", options.is_json ? protocol::to_json(summary->run) : protocol::to_table(summary->run));
  return kSuccess;
}

Result<wire::SimulateReport> simulate_until_done(const Options& options, const ros::NodeOptions& node) {
  const Result<scenario::Scenario> scenario = experiment(options);
  if (!scenario) return fail(scenario.error());
  const Result<path::Track> track = run::make_track(*scenario);
  if (!track) return fail(track.error());
  protocol::Run description;
  description.controller = description.preset = "external";
  description.vehicle = scenario->vehicle;
  description.mode = recording::kSimulateMode;
  description.limit = live::RunLimit::first_answer(*track);
  live::describe(*track, description);
  const auto kept = KeptRun::start(options, description, *scenario, 0.0);
  if (!kept) return fail(kept.error());
  Progress progress;
  progress.say(fmt::format("{} on {} waits for {} in DDS domain {} (Ctrl-C ends)", scenario->car,
                           track->name(), node.topics.drive, node.network.domain));
  auto done = ros::simulate(node, *scenario,
                            {.on_frame =
                                 [&](const telemetry::Frame& frame) {
                                   (*kept)->record(frame);
                                   progress.show(frame);
                                 },
                             .on_lap =
                                 [&](const telemetry::CompletedLap& lap) {
                                   (*kept)->record(lap);
                                   progress.say(line_of(lap));
                                 },
                             .log = [&](std::string_view line) { progress.say(line); }},
                            ros_stop);
  if (const Result<void> finished = (*kept)->finish(); done && !finished) return fail(finished.error());
  return done;
}

ExitCode simulate_node(const Options& options, const ros::NodeOptions& node) {
  const Result<wire::SimulateReport> done = simulate_until_done(options, node);
  if (!done) return report(done.error());
  fmt::print("{}", options.is_json ? protocol::to_json(done->run) : protocol::to_table(done->run));
  fmt::print(stderr, "{} commands of {} senders; {} broken, {} times stopped without one\n", done->answers,
             done->connections, done->broken_answers, done->stops);
  return completed_on_road(done->run) ? kSuccess : kRunFailed;
}

}  // namespace

ExitCode ros_node(const Options& told) {
  catch_interrupts(ros_stop);
  const Options options = with_car(told);
  const ros::NodeOptions node = node_of(options);
  if (const Result<void> sound = check_topics(node.topics); !sound) return report(sound.error());
  return options.ros.is_simulator ? simulate_node(options, node) : drive_node(options, node);
}

}  // namespace chicane::apps
