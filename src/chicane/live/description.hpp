// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/protocol/ros_messages.hpp"
#include "chicane/road/track.hpp"
#include "chicane/run/closed_loop.hpp"

namespace chicane::live {

/// The road of a run, for viewers and recordings: name, length, lines.
void describe(const road::Track& track, protocol::Run& run);

/// Car, notices and where car and road come from; reads their files.
void describe(const scenario::Scenario& scenario, protocol::Run& run);

/// A run with our simulator, for viewers and recordings; without its limit.
[[nodiscard]] protocol::Run description(const run::ClosedLoop& loop);

}  // namespace chicane::live
