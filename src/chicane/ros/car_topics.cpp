// SPDX-License-Identifier: MIT
// Topics between a controller and its car: commands as drive messages, odometry as measurements, poses in a
// tree of frames, and reports on partners that are missing or do not fit.
#include "chicane/ros/car_topics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/run/make.hpp"
#include "chicane/sim/world.hpp"

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
  // Two readers of the path: only a transient local one gets a path that was sent before, and only a volatile
  // one gets paths of a volatile sender.
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

namespace {

// Chosen.
constexpr double kHalfWidth = 4.0;  // [m] half width of a road given as a path, in full size
// Largest distance from the last to the first point of a lap, in mean steps.
constexpr double kClosedInSteps = 3.0;
constexpr std::size_t kSmallestLap = 8;  // least points of a lap
constexpr double kSamePoint = 1e-3;      // [m] distance below which two points of a path are one

/// Whether the points of a path are a circuit.
bool is_lap(const std::vector<Vec2>& points) {
  if (points.size() < kSmallestLap) return false;
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  const double step = length / static_cast<double>(points.size() - 1);
  return (points.back() - points.front()).norm() <= kClosedInSteps * step;
}

}  // namespace

CarSight::CarSight(const scenario::Scenario& scenario, const road::Track* track, bool is_base_at_rear_axle)
    : scenario_{scenario}, base_ahead_{is_base_at_rear_axle ? scenario.vehicle.rear_axle : 0.0} {
  if (track == nullptr) return;
  if (auto waypoints = run::make_waypoints(*track, scenario.vehicle.scale))
    waypoints_ = std::move(*waypoints);
}

Result<void> CarSight::use_path(const std::vector<Vec2>& points) {
  if (points == path_) return {};
  const double width = kHalfWidth * scenario_.vehicle.scale;
  std::vector<road::TrackPoint> road;
  for (const Vec2& point : points) {
    if (road.empty() || (point - road.back().position).norm() > kSamePoint)
      road.push_back({.position = point, .left = width, .right = width});
  }
  auto track = road::Track::create("path", road, is_lap(points),
                                   {.spacing = std::max(0.05, 2.0 * scenario_.vehicle.scale)});
  if (!track) return fail(track.error());
  auto waypoints = run::make_waypoints(*track, scenario_.vehicle.scale);
  if (!waypoints) return fail(waypoints.error());
  waypoints_ = std::move(*waypoints);
  path_ = points;
  return {};
}

model::Pose CarSight::centre_of_mass(const model::Pose& base) const noexcept {
  return {.x = base.x + base_ahead_ * chicane::cos(base.psi),
          .y = base.y + base_ahead_ * chicane::sin(base.psi),
          .psi = base.psi};
}

std::optional<model::Measurement> CarSight::measure(const protocol::OdometryMessage& odometry,
                                                    double time) noexcept {
  const double vy = odometry.vy + base_ahead_ * odometry.yaw_rate;
  const double speed = std::sqrt(odometry.vx * odometry.vx + vy * vy);
  const model::Pose pose = centre_of_mass(odometry.pose);
  const bool is_finite =
      std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.psi) && std::isfinite(speed);
  if (!is_finite) return std::nullopt;
  const model::Command now = acting(time);
  model::Measurement measured{.time = time,
                              .x = pose.x,
                              .y = pose.y,
                              .psi = pose.psi,
                              .speed = speed,
                              .steer = now.steer,
                              .throttle = std::max(0.0, now.throttle)};
  if (waypoints_) sim::select_waypoints(*waypoints_, pose, scenario_.waypoints_sent, measured);
  return measured;
}

void CarSight::sent(double time, const model::Command& command) noexcept {
  sent_[count_++ % sent_.size()] = {time, command};
}

model::Command CarSight::acting(double time) const noexcept {
  const std::size_t known = std::min(count_, sent_.size());
  for (std::size_t back = 1; back <= known; ++back) {
    const Sent& each = sent_[(count_ - back) % sent_.size()];
    if (each.time + scenario_.latency <= time || back == known) return each.command;
  }
  return {};
}

namespace {

/// Pose of the parent in a frame that has `pose` in the parent.
model::Pose inverse(const model::Pose& pose) noexcept {
  const double c = chicane::cos(pose.psi), s = chicane::sin(pose.psi);
  return {.x = -c * pose.x - s * pose.y, .y = s * pose.x - c * pose.y, .psi = -pose.psi};
}

/// Name of a frame without a slash in front: tf had one, tf2 has none.
std::string plain(const std::string& name) { return name.starts_with('/') ? name.substr(1) : name; }

}  // namespace

model::Pose composed(const model::Pose& frame, const model::Pose& inner) noexcept {
  const double c = chicane::cos(frame.psi), s = chicane::sin(frame.psi);
  return {.x = frame.x + c * inner.x - s * inner.y,
          .y = frame.y + s * inner.x + c * inner.y,
          .psi = wrap_angle(frame.psi + inner.psi)};
}

void FrameTree::put(const protocol::TransformMessage& transform) {
  const model::Pose& pose = transform.pose;
  if (!std::isfinite(pose.x) || !std::isfinite(pose.y) || !std::isfinite(pose.psi)) return;
  const std::string child = plain(transform.child_frame);
  if (links_.size() >= kCapacity && links_.count(child) == 0) return;
  links_[child] = {plain(transform.frame), pose};
}

std::map<std::string, model::Pose> FrameTree::seen_from_parents(const std::string& frame) const {
  std::map<std::string, model::Pose> seen{{frame, {}}};
  std::string at = frame;
  model::Pose pose;
  for (int i = 0; i < kDeepest; ++i) {
    const auto link = links_.find(at);
    if (link == links_.end()) break;
    pose = composed(link->second.pose, pose);
    at = link->second.parent;
    if (!seen.emplace(at, pose).second) break;  // a ring
  }
  return seen;
}

std::optional<model::Pose> FrameTree::find(const std::string& in, const std::string& frame) const {
  const auto of_frame = seen_from_parents(plain(frame));
  for (const auto& [parent, pose] : seen_from_parents(plain(in)))
    if (const auto same = of_frame.find(parent); same != of_frame.end())
      return composed(inverse(pose), same->second);
  return std::nullopt;
}

}  // namespace chicane::ros
