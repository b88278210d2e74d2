// SPDX-License-Identifier: MIT
#pragma once

#include "options.hpp"

namespace chicane::apps {

/// The controller as a ROS 2 node, or the simulator for one.
[[nodiscard]] ExitCode ros_node(const Options& options);

}  // namespace chicane::apps
