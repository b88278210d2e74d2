// SPDX-License-Identifier: MIT
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

/// Message for a command that acts at `speed` [m/s]: its acceleration, and the speed by which a speed
/// controller reaches it, never below 0. Stamp and frame are left empty.
[[nodiscard]] protocol::DriveMessage to_message(const model::VehicleParams& vehicle,
                                                const model::Command& command, double speed,
                                                const DriveOptions& options) noexcept;

/// The pedal with which a car at `speed` [m/s] follows: its own speed controller, or the acceleration.
/// `wanted`: the message's speed [m/s] or acceleration [m/s²], as `options` say.
[[nodiscard]] double throttle_of(const model::VehicleParams& vehicle, double wanted, double speed,
                                 const DriveOptions& options) noexcept;

/// One topic of ours that needs a partner.
struct WantedPartner {
  bool is_reader = true;  ///< we read, the partner writes
  std::string topic{};
  std::string type{};
  Qos qos{};
  std::string qos_option{};    ///< option that changes qos.is_reliable: "--odom-qos"
  std::string topic_option{};  ///< option that renames the topic: "--odom-topic"
  bool is_awaited = true;      ///< reported as missing without a partner
};

/// Finds out why nothing arrives: a partner of another type, with qualities of service that do not fit, under
/// another name, or none at all. Says each thing once, and again when it was different meanwhile. No DDS, no
/// clock: both come in.
class PartnerWatch {
 public:
  /// `missed_after`: time without a partner after which it is reported as missing [s].
  PartnerWatch(std::vector<WantedPartner> wanted, NetworkOptions network, double missed_after = 3.0);

  /// Reports due at `time` [s], rising. `others`: Participant::others(); `matched`: the partners of each
  /// wanted topic, in their order.
  [[nodiscard]] std::vector<std::string> look(double time, const std::vector<Endpoint>& others,
                                              const std::vector<int>& matched);

 private:
  struct Entry {
    WantedPartner wanted;
    int matched = 0;
    double alone_since = 0.0;
    bool is_missed = false;
  };
  void look_at(const Endpoint& other, const Entry& entry, std::set<std::string>& said) const;
  [[nodiscard]] std::string missing(const Entry& entry, const std::vector<Endpoint>& others) const;

  std::vector<Entry> entries_;
  NetworkOptions network_;
  double missed_after_;
  std::set<std::string> misfits_;  ///< said at the last look
};

/// The topics of the controller that need a partner: odometry, drive, then what `node` asks for.
[[nodiscard]] std::vector<WantedPartner> wanted_partners(const NodeOptions& node);

/// The controller's ends of the topics; null where their names are empty.
struct CarTopics {
  std::unique_ptr<Reader> odom{}, path{}, kept_path{}, initial_pose{}, stop{};
  std::unique_ptr<Reader> transforms{}, fixed_transforms{};  ///< /tf, /tf_static
  std::unique_ptr<Reader> clock{};                           ///< null where time is not simulated
  std::unique_ptr<Writer> drive{}, autoware{}, stop_plan{};

  [[nodiscard]] static Result<CarTopics> create(Participant& at, const NodeOptions& node);
  /// Readers and writers with a partner, in the order of wanted_partners().
  [[nodiscard]] std::vector<int> matched() const;
};

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
