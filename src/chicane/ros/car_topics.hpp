// SPDX-License-Identifier: MIT
// ROS 2 topics between a controller and its car: conversion of commands and odometry, frames, and reports on
// missing partners.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/protocol/car_messages.hpp"
#include "chicane/road/track.hpp"
#include "chicane/ros/dds.hpp"
#include "chicane/ros/nodes.hpp"
#include "chicane/scenario/scenario.hpp"

namespace chicane::ros {

/// Message for a command that acts at `speed` [m/s]: the acceleration of the command, and the speed by which
/// the car's speed controller reaches it, at least 0. Stamp and frame are left empty.
[[nodiscard]] protocol::DriveMessage to_message(const model::VehicleParams& vehicle,
                                                const model::Command& command, double speed,
                                                const DriveOptions& options) noexcept;

/// Pedal of a car at `speed` [m/s] that follows a message. `wanted`: the message's speed [m/s] or
/// acceleration [m/s²], as `options` select.
[[nodiscard]] double throttle_of(const model::VehicleParams& vehicle, double wanted, double speed,
                                 const DriveOptions& options) noexcept;

/// Topic of ours that needs a partner.
struct WantedPartner {
  bool is_reader = true;       ///< this program reads, and the partner writes
  std::string topic{};         ///< name in ROS 2
  std::string type{};          ///< type in ROS 2
  Qos qos{};                   ///< our quality of service
  std::string qos_option{};    ///< option that changes qos.is_reliable: "--odom-qos"
  std::string topic_option{};  ///< option that renames the topic: "--odom-topic"
  bool is_awaited = true;      ///< reported as missing without a partner
};

/// Finds the reason for which nothing arrives: a partner of another type, with an incompatible quality of
/// service, under another name, or none. Reports each finding once, and again after it was gone. Uses neither
/// DDS nor clock: both are arguments.
class PartnerWatch {
 public:
  /// `missed_after`: time without a partner after which it is reported as missing [s]; default chosen.
  PartnerWatch(std::vector<WantedPartner> wanted, NetworkOptions network, double missed_after = 3.0);

  /// Reports that are due at `time` [s], which rises. `others`: Participant::others(). `matched`: number of
  /// partners of each wanted topic, in order.
  [[nodiscard]] std::vector<std::string> look(double time, const std::vector<Endpoint>& others,
                                              const std::vector<int>& matched);

 private:
  /// State of a wanted topic.
  struct Entry {
    WantedPartner wanted;
    int matched = 0;           ///< partners at the last look
    double alone_since = 0.0;  ///< time of the last look with a partner [s]
    bool is_missed = false;    ///< the missing partner was reported
  };
  /// Adds the reasons for which `other` does not fit a wanted topic to `said`.
  void look_at(const Endpoint& other, const Entry& entry, std::set<std::string>& said) const;
  /// Report of a missing partner.
  [[nodiscard]] std::string missing(const Entry& entry, const std::vector<Endpoint>& others) const;

  std::vector<Entry> entries_;  ///< wanted topics
  NetworkOptions network_;
  double missed_after_;            ///< time without a partner before the report [s]
  std::set<std::string> misfits_;  ///< reasons found at the last look
};

/// Topics of the controller that need a partner: odometry and drive, then clock and path if `node` uses them.
[[nodiscard]] std::vector<WantedPartner> wanted_partners(const NodeOptions& node);

/// Readers and writers of the controller; null for topics without a name.
struct CarTopics {
  /// Readers of the topics in TopicNames; kept_path gets the path that was sent before this program began.
  std::unique_ptr<Reader> odom{}, path{}, kept_path{}, initial_pose{}, stop{};
  std::unique_ptr<Reader> transforms{}, fixed_transforms{};  ///< readers of /tf, /tf_static
  std::unique_ptr<Reader> clock{};  ///< reader of /clock; null unless time is simulated
  std::unique_ptr<Writer> drive{}, autoware{}, stop_plan{};  ///< writers of the topics in TopicNames

  /// Creates all readers and writers. Fails as Participant.
  [[nodiscard]] static Result<CarTopics> create(Participant& at, const NodeOptions& node);
  /// Numbers of partners of the topics, in the order of wanted_partners().
  [[nodiscard]] std::vector<int> matched() const;
};

/// Makes a controller's measurement from odometry: the centre of mass in W, the road ahead as waypoints, and
/// the command that acts now, which odometry lacks. One thread.
class CarSight {
 public:
  /// `track`: the road, or null if it comes as a path. `is_base_at_rear_axle`: as in NodeOptions.
  CarSight(const scenario::Scenario& scenario, const road::Track* track, bool is_base_at_rear_axle);

  /// Replaces the road by the points of a nav_msgs/Path in driving order; a circuit if the last point is near
  /// the first. Fails, without a change, for points that make no road. Allocates.
  [[nodiscard]] Result<void> use_path(const std::vector<Vec2>& points);
  [[nodiscard]] bool has_road() const { return waypoints_.has_value(); }

  /// Measurement for odometry of the time `time` [s]; none if numbers are not finite.
  [[nodiscard]] std::optional<model::Measurement> measure(const protocol::OdometryMessage& odometry,
                                                          double time) noexcept;
  /// Remembers a command that was sent at `time` [s].
  void sent(double time, const model::Command& command) noexcept;
  /// Pose of the centre of mass for the pose of the odometry's child frame.
  [[nodiscard]] model::Pose centre_of_mass(const model::Pose& base) const noexcept;

 private:
  /// Command and the time at which it was sent [s].
  struct Sent {
    double time = 0.0;
    model::Command command{};
  };
  /// Newest command that was sent at least a latency before `time` [s], or the oldest remembered one.
  [[nodiscard]] model::Command acting(double time) const noexcept;

  scenario::Scenario scenario_;
  double base_ahead_;                     ///< distance of the centre of mass ahead of the base [m]
  std::optional<road::Track> waypoints_;  ///< road as waypoints; none: no road yet
  std::vector<Vec2> path_;                ///< points of the last path
  std::array<Sent, 64> sent_{};           ///< ring of sent commands; size chosen: seconds of them
  std::size_t count_ = 0;                 ///< commands sent so far
};

/// Pose in the parent frame of a body with the pose `inner` in a frame, which has the pose `frame` in the
/// parent.
[[nodiscard]] model::Pose composed(const model::Pose& frame, const model::Pose& inner) noexcept;

/// Tree of frames with their newest poses in the plane, from /tf and /tf_static. One thread.
class FrameTree {
 public:
  // Chosen.
  static constexpr std::size_t kCapacity = 1000;  ///< most frames; transforms of further ones are left out
  static constexpr int kDeepest = 32;             ///< most frames in a chain of parents

  /// Sets a transform; ignores numbers that are not finite.
  void put(const protocol::TransformMessage& transform);
  /// Pose of `frame` in `in`; none if their chains of parents do not meet.
  [[nodiscard]] std::optional<model::Pose> find(const std::string& in, const std::string& frame) const;

 private:
  /// Parent of a frame, and the frame's pose in it.
  struct Link {
    std::string parent{};
    model::Pose pose{};
  };
  /// Poses of `frame` in itself and in each of its parents, by the parent's name.
  [[nodiscard]] std::map<std::string, model::Pose> seen_from_parents(const std::string& frame) const;

  std::map<std::string, Link> links_;  ///< links by the frame's name
};

}  // namespace chicane::ros
