// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "chicane/protocol/ros_messages.hpp"
#include "chicane/telemetry/frame.hpp"

namespace chicane::protocol {

/// Road and car as foxglove_msgs/msg/SceneUpdate, for the 3D panels of Foxglove and Lichtblick: the road in
/// `map`, the car in `base_link`, with which it moves. Nothing of it depends on the frame.
[[nodiscard]] std::string encode_scene(const telemetry::Frame& frame, const Run& run);

}  // namespace chicane::protocol
