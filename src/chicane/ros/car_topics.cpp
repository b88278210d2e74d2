// SPDX-License-Identifier: MIT
// Topics between a controller and its car: conversion of commands to drive messages, and reports on partners
// that are missing or do not fit.
#include "chicane/ros/car_topics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <utility>

#include "chicane/protocol/car_messages.hpp"
#include "chicane/ros/dds.hpp"

namespace chicane::ros {

protocol::DriveMessage to_message(const model::VehicleParams& vehicle, const model::Command& command,
                                  double speed, const DriveOptions& options) noexcept {
  protocol::DriveMessage message;
  message.steer = command.steer;
  message.acceleration = model::longitudinal_acceleration(vehicle, command.throttle, speed);
  message.speed = std::max(0.0, speed + options.speed_lead * message.acceleration);
  return message;
}

double throttle_of(const model::VehicleParams& vehicle, double wanted, double speed,
                   const DriveOptions& options) noexcept {
  const double acceleration = options.is_by_speed ? (wanted - speed) / options.speed_lead : wanted;
  const bool is_coming_to_rest = options.is_by_speed && wanted <= 0.0 && acceleration < 0.0;
  return is_coming_to_rest ? model::throttle_to_rest(vehicle, acceleration, speed)
                           : model::throttle_for(vehicle, acceleration, speed);
}

PartnerWatch::PartnerWatch(std::vector<WantedPartner> wanted, NetworkOptions network, double missed_after)
    : network_{std::move(network)}, missed_after_{missed_after} {
  for (WantedPartner& each : wanted) entries_.push_back({.wanted = std::move(each)});
}

std::vector<std::string> PartnerWatch::look(double time, const std::vector<Endpoint>& others,
                                            const std::vector<int>& matched) {
  std::vector<std::string> lines;
  std::set<std::string> misfits;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    Entry& entry = entries_[i];
    for (const Endpoint& other : others) look_at(other, entry, misfits);
    const int before = std::exchange(entry.matched, matched[i]);
    const char* partner = entry.wanted.is_reader ? "sender" : "reader";
    if (before == 0 && entry.matched > 0)
      lines.push_back(fmt::format("{} has a {}", entry.wanted.topic, partner));
    if (before > 0 && entry.matched == 0)
      lines.push_back(fmt::format("{} has no {} any more", entry.wanted.topic, partner));
    if (entry.matched > 0 || before > 0) {
      entry.alone_since = time;
      entry.is_missed = false;
    }
    const bool is_late = entry.wanted.is_awaited && time - entry.alone_since >= missed_after_;
    if (entry.matched > 0 || entry.is_missed || !is_late) continue;
    entry.is_missed = true;
    lines.push_back(missing(entry, others));
  }
  for (const std::string& misfit : misfits)
    if (misfits_.count(misfit) == 0) lines.push_back(misfit);
  misfits_ = std::move(misfits);
  return lines;
}

void PartnerWatch::look_at(const Endpoint& other, const Entry& entry, std::set<std::string>& said) const {
  const WantedPartner& wanted = entry.wanted;
  if (other.is_writer != wanted.is_reader || other.topic != wanted.topic) return;
  const char* verb = wanted.is_reader ? "sent" : "read";
  if (other.type != wanted.type) {
    said.insert(
        fmt::format("{}: got a partner with type {}, expected {}", wanted.topic, other.type, wanted.type));
    return;
  }
  const Qos& writer = wanted.is_reader ? other.qos : wanted.qos;
  const Qos& reader = wanted.is_reader ? wanted.qos : other.qos;
  if (reader.is_reliable && !writer.is_reliable) {
    said.insert(fmt::format("{} is {} {} by a partner, and this program {} it {}: nothing arrives; use {} {}",
                            wanted.topic, verb, wanted.is_reader ? "best effort" : "reliably",
                            wanted.is_reader ? "reads" : "sends",
                            wanted.is_reader ? "reliably" : "best effort", wanted.qos_option,
                            wanted.is_reader ? "best-effort" : "reliable"));
  }
  if (reader.is_transient_local && !writer.is_transient_local) {
    said.insert(
        fmt::format("{}: the reader wants transient local messages, the sender has volatile ones: "
                    "nothing arrives; use volatile at the reader",
                    wanted.topic));
  }
}

std::string PartnerWatch::missing(const Entry& entry, const std::vector<Endpoint>& others) const {
  const WantedPartner& wanted = entry.wanted;
  const std::string what = fmt::format("nobody {} {}", wanted.is_reader ? "sends" : "reads", wanted.topic);
  if (others.empty()) {
    const std::string where =
        network_.interface == "lo"
            ? "this program listens on this machine's loopback alone: --interface NAME|auto for others"
            : fmt::format("interface {}: --peer ADDRESS where there is no multicast", network_.interface);
    return fmt::format("{}, and there is no other program in domain {}: is its ROS_DOMAIN_ID the same? ({})",
                       what, network_.domain, where);
  }
  std::set<std::string> elsewhere;
  for (const Endpoint& other : others) {
    if (other.is_writer == wanted.is_reader && other.type == wanted.type && other.topic != wanted.topic)
      elsewhere.insert(other.topic);
  }
  if (elsewhere.empty()) return fmt::format("{}, of type {}", what, wanted.type);
  return fmt::format("{}; {} is on {}: {} names another topic", what, wanted.type, fmt::join(elsewhere, ", "),
                     wanted.topic_option);
}

std::vector<WantedPartner> wanted_partners(const NodeOptions& node) {
  const Qos any{.is_reliable = false};
  std::vector<WantedPartner> wanted{{true, node.topics.odom, std::string(protocol::OdometryMessage::kType),
                                     node.odom_qos, "--odom-qos", "--odom-topic"},
                                    {false, node.topics.drive, std::string(protocol::DriveMessage::kType),
                                     node.drive_qos, "--drive-qos", "--drive-topic"}};
  if (node.is_time_simulated)
    wanted.push_back({true, "/clock", std::string(protocol::ClockMessage::kType), any});
  if (!node.topics.path.empty())
    wanted.push_back(
        {true, node.topics.path, std::string(protocol::PathMessage::kType), any, "", "--path-topic"});
  return wanted;
}

Result<CarTopics> CarTopics::create(Participant& at, const NodeOptions& node) {
  CarTopics topics;
  Endpoints endpoints{at};
  const Qos any{.is_reliable = false};
  endpoints.read(topics.odom, node.topics.odom, protocol::OdometryMessage::kType, node.odom_qos);
  endpoints.read(topics.path, node.topics.path, protocol::PathMessage::kType, any);
  // One that was sent before, too: a volatile reader gets none of those, and a transient local one no
  // others.
  endpoints.read(topics.kept_path, node.topics.path, protocol::PathMessage::kType,
                 {.is_transient_local = true, .depth = 1});
  endpoints.read(topics.transforms, "/tf", protocol::TransformsMessage::kType,
                 {.is_reliable = false, .depth = 100});
  endpoints.read(topics.fixed_transforms, "/tf_static", protocol::TransformsMessage::kType,
                 {.is_transient_local = true, .depth = 100});
  if (node.is_time_simulated) endpoints.read(topics.clock, "/clock", protocol::ClockMessage::kType, any);
  endpoints.read(topics.initial_pose, node.topics.initial_pose, protocol::PoseMessage::kType, {});
  endpoints.read(topics.stop, node.topics.stop, protocol::BoolMessage::kType, {});
  endpoints.send(topics.drive, node.topics.drive, protocol::DriveMessage::kType, node.drive_qos);
  endpoints.send(topics.autoware, node.topics.autoware, protocol::AutowareMessage::kType, node.drive_qos);
  endpoints.send(topics.stop_plan, node.topics.stop_plan, protocol::StopMessage::kType, node.drive_qos);
  if (!endpoints.made()) return fail(endpoints.made().error());
  return topics;
}

std::vector<int> CarTopics::matched() const {
  std::vector<int> matched{odom->matched(), drive ? drive->matched() : 0};
  if (clock) matched.push_back(clock->matched());
  if (path) matched.push_back(path->matched());
  return matched;
}

}  // namespace chicane::ros
