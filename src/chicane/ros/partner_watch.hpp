// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <string>
#include <vector>

#include "chicane/ros/dds.hpp"

namespace chicane::ros {

/// One topic of ours that needs a partner.
struct WantedPartner {
  bool is_reader = true;  ///< we read, the partner writes
  std::string topic{};
  std::string type{};
  Qos qos{};
  std::string qos_option{};    ///< that changes qos.is_reliable: "--odom-qos"
  std::string topic_option{};  ///< that names another topic: "--odom-topic"
  bool is_awaited = true;      ///< to be missed when nobody is there
};

/// Finds out why nothing arrives: a partner of another type, with qualities of service that do not fit, under
/// another name, or none at all. Says each thing once, and again when it was different meanwhile. No DDS, no
/// clock: both come in.
class PartnerWatch {
 public:
  /// `missed_after`: without a partner for so long it is missed [s].
  PartnerWatch(std::vector<WantedPartner> wanted, NetworkOptions network, double missed_after = 3.0);

  /// What is to be said at `time` [s], rising. `others`: Participant::others(); `matched`: the partners of
  /// each wanted topic, in their order.
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

}  // namespace chicane::ros
