// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "chicane/protocol/ros_messages.hpp"

namespace chicane::protocol {

/// A message of chicane_msgs: a list of rows, name, meaning and value, from which its bytes and its
/// definition are made.
struct OwnMessage {
  std::string_view name;   ///< "chicane_msgs/Run"
  std::string definition;  ///< text in ROS 2's .msg language
  std::string (*encode)(const telemetry::Frame& frame, const Run& run) = nullptr;  ///< null: not of a frame
};

[[nodiscard]] const std::vector<OwnMessage>& own_messages();

}  // namespace chicane::protocol
