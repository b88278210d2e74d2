// SPDX-License-Identifier: MIT
#pragma once

#include "options.hpp"

namespace CLI {
class App;
}

namespace chicane::apps {

/// The options of `chicane ros` that are its own: network, topics, frames, what a drive message means.
void add_ros_network(CLI::App& command, Options& options);

}  // namespace chicane::apps
