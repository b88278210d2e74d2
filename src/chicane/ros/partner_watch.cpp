// SPDX-License-Identifier: MIT
#include "chicane/ros/partner_watch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

namespace chicane::ros {

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

}  // namespace chicane::ros
