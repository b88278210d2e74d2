// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "chicane/net/server.hpp"
#include "chicane/protocol/foxglove_codec.hpp"
#include "chicane/protocol/ros_messages.hpp"

/// The numbers of a viewer's channels: the topics in their order, then the frames of before.
namespace chicane::wire::detail {

inline constexpr std::string_view kPastTopic = "/chicane/past";

[[nodiscard]] inline std::uint32_t past_channel() {
  return static_cast<std::uint32_t>(protocol::ros_topics().size());
}

[[nodiscard]] inline std::uint32_t channel_of(protocol::Cadence cadence) {
  const auto& topics = protocol::ros_topics();
  const auto found = std::find_if(topics.begin(), topics.end(),
                                  [&](const protocol::RosTopic& topic) { return topic.cadence == cadence; });
  return static_cast<std::uint32_t>(found - topics.begin());
}

[[nodiscard]] inline std::uint32_t change_channel() {
  static const auto channel = channel_of(protocol::Cadence::kEvent);
  return channel;
}

[[nodiscard]] inline std::uint32_t lap_channel() {
  static const auto channel = channel_of(protocol::Cadence::kLap);
  return channel;
}

[[nodiscard]] inline std::uint32_t frame_channel() {
  static const auto channel = channel_of(protocol::Cadence::kFrame);
  return channel;
}

/// Whether the messages of a topic go with each frame also while a slow line carries the past.
[[nodiscard]] inline bool goes_with_frame(std::string_view topic) {
  return topic == "/chicane/frame" || topic == "/chicane/situation";
}

/// One message of a channel.
[[nodiscard]] inline net::Bytes data_of(std::uint32_t subscription, double time, std::string_view payload) {
  return std::make_shared<const std::string>(
      protocol::foxglove::message_data(subscription, protocol::to_nanoseconds(time), payload));
}

/// A frame is stale once the next one is there; descriptions of the run must arrive.
[[nodiscard]] inline net::Delivery delivery_of(protocol::Cadence cadence) {
  return cadence == protocol::Cadence::kFrame ? net::Delivery::kNewest : net::Delivery::kReliable;
}

}  // namespace chicane::wire::detail
