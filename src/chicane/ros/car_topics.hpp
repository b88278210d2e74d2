// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/protocol/car_messages.hpp"
#include "chicane/ros/dds.hpp"
#include "chicane/ros/nodes.hpp"

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

}  // namespace chicane::ros
