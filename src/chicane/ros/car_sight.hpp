// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/model/state.hpp"
#include "chicane/protocol/car_messages.hpp"
#include "chicane/road/track.hpp"
#include "chicane/scenario/scenario.hpp"

namespace chicane::ros {

/// Turns odometry into a controller's measurement: the centre of mass in W, the road ahead as waypoints, and
/// the command that acts now, which odometry lacks. One thread.
class CarSight {
 public:
  /// `track`: the road, or null where it comes as a path. `is_base_at_rear_axle`: NodeOptions'.
  CarSight(const scenario::Scenario& scenario, const road::Track* track, bool is_base_at_rear_axle);

  /// Takes another road: the points of a nav_msgs/Path in driving order, a lap if the last is near the first.
  /// No change for points that are no road. Allocates.
  [[nodiscard]] Result<void> use_path(const std::vector<Vec2>& points);
  [[nodiscard]] bool has_road() const { return waypoints_.has_value(); }

  /// Odometry at `time` [s] as a measurement; none where it has numbers that are not finite.
  [[nodiscard]] std::optional<model::Measurement> measure(const protocol::OdometryMessage& odometry,
                                                          double time) noexcept;
  /// A command was sent at `time` [s].
  void sent(double time, const model::Command& command) noexcept;
  /// The centre of mass for the pose of the odometry's child frame.
  [[nodiscard]] model::Pose centre_of_mass(const model::Pose& base) const noexcept;

 private:
  struct Sent {
    double time = 0.0;
    model::Command command{};
  };
  [[nodiscard]] model::Command acting(double time) const noexcept;

  scenario::Scenario scenario_;
  double base_ahead_;  ///< distance of the centre of mass ahead of the base [m]
  std::optional<road::Track> waypoints_;
  std::vector<Vec2> path_;
  std::array<Sent, 64> sent_{};
  std::size_t count_ = 0;
};

/// Pose of a body with `inner` in a frame, seen from the parent in which that frame has `frame`.
[[nodiscard]] model::Pose composed(const model::Pose& frame, const model::Pose& inner) noexcept;

/// Frames and their poses in the plane, as /tf and /tf_static give them: the newest of each. One thread.
class FrameTree {
 public:
  static constexpr std::size_t kCapacity = 1000;  ///< frames; transforms of further ones are left out
  static constexpr int kDeepest = 32;             ///< frames in a chain

  /// Leaves out numbers that are not finite.
  void put(const protocol::TransformMessage& transform);
  /// Pose of `frame` in `in`; none if their chains of parents do not meet.
  [[nodiscard]] std::optional<model::Pose> find(const std::string& in, const std::string& frame) const;

 private:
  struct Link {
    std::string parent{};
    model::Pose pose{};  ///< pose in the parent
  };
  [[nodiscard]] std::map<std::string, model::Pose> seen_from_parents(const std::string& frame) const;

  std::map<std::string, Link> links_;  ///< links by child
};

}  // namespace chicane::ros
