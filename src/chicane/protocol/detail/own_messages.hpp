// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "chicane/protocol/ros_messages.hpp"
#include "chicane/telemetry/frame.hpp"

namespace chicane::protocol {

/// A message of chicane_msgs: a list of rows, name, meaning and value, from which its bytes and its
/// definition are made.
struct OwnMessage {
  std::string_view name;   ///< "chicane_msgs/Run"
  std::string definition;  ///< text in ROS 2's .msg language
  std::string (*encode)(const telemetry::Frame& frame, const Run& run) = nullptr;  ///< null: not of a frame
};

[[nodiscard]] const std::vector<OwnMessage>& own_messages();

/// Road and car as foxglove_msgs/msg/SceneUpdate, for the 3D panels of Foxglove and Lichtblick: the road in
/// `map`, the car in `base_link`, with which it moves. Nothing of it depends on the frame.
[[nodiscard]] std::string encode_scene(const telemetry::Frame& frame, const Run& run);

}  // namespace chicane::protocol
