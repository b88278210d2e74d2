// SPDX-License-Identifier: MIT
#include "chicane/ros/frame_tree.hpp"

#include <cmath>

#include "chicane/base/angle.hpp"
#include "chicane/base/math.hpp"

namespace chicane::ros {
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
