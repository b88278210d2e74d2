// SPDX-License-Identifier: MIT
// Channels of a viewer, and messages for them. Channels are numbered: the topics of protocol::ros_topics() in
// their order, then past frames.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "chicane/net/server.hpp"
#include "chicane/protocol/foxglove_codec.hpp"
#include "chicane/protocol/ros_messages.hpp"

namespace chicane::wire::detail {

/// Topic of the frames before the connection.
inline constexpr std::string_view kPastTopic = "/chicane/past";

/// Channel of kPastTopic.
[[nodiscard]] inline std::uint32_t past_channel() {
  return static_cast<std::uint32_t>(protocol::ros_topics().size());
}

/// Channel of the first topic with a cadence.
[[nodiscard]] inline std::uint32_t channel_of(protocol::Cadence cadence) {
  const auto& topics = protocol::ros_topics();
  const auto found = std::find_if(topics.begin(), topics.end(),
                                  [&](const protocol::RosTopic& topic) { return topic.cadence == cadence; });
  return static_cast<std::uint32_t>(found - topics.begin());
}

/// Whether a topic is sent with each frame even while past frames are sent over a slow link.
[[nodiscard]] inline bool goes_with_frame(std::string_view topic) {
  return topic == "/chicane/frame" || topic == "/chicane/situation";
}

/// Message of a channel to one subscription, at the run's `time` [s].
[[nodiscard]] inline net::Bytes data_of(std::uint32_t subscription, double time, std::string_view payload) {
  return std::make_shared<const std::string>(
      protocol::foxglove::message_data(subscription, protocol::to_nanoseconds(time), payload));
}

/// Delivery of a topic: a newer frame replaces a waiting one, descriptions of the run must arrive.
[[nodiscard]] inline net::Delivery delivery_of(protocol::Cadence cadence) {
  return cadence == protocol::Cadence::kFrame ? net::Delivery::kNewest : net::Delivery::kReliable;
}

}  // namespace chicane::wire::detail
