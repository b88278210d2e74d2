// SPDX-License-Identifier: MIT
// Measurements from odometry, and the tree of frames for poses.
#include "chicane/ros/car_sight.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/run/make.hpp"
#include "chicane/sim/world.hpp"

namespace chicane::ros {
namespace {

constexpr double kHalfWidth = 4.0;      // half width of a road given as a path, for a car in full size [m]
constexpr double kClosedInSteps = 3.0;  // a lap's last point is so near to its first, in mean steps
constexpr std::size_t kSmallestLap = 8;

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
    if (road.empty() || (point - road.back().position).norm() > 1e-3)
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

/// The newest command that was sent a latency ago, or the oldest that is remembered.
model::Command CarSight::acting(double time) const noexcept {
  const std::size_t known = std::min(count_, sent_.size());
  for (std::size_t back = 1; back <= known; ++back) {
    const Sent& each = sent_[(count_ - back) % sent_.size()];
    if (each.time + scenario_.latency <= time || back == known) return each.command;
  }
  return {};
}

namespace {

model::Pose inverse(const model::Pose& pose) noexcept {
  const double c = chicane::cos(pose.psi), s = chicane::sin(pose.psi);
  return {.x = -c * pose.x - s * pose.y, .y = s * pose.x - c * pose.y, .psi = -pose.psi};
}

/// Names with and without a slash in front are the same frame: tf had it, tf2 has not.
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

/// The poses of `frame` in itself and each of its parents.
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
