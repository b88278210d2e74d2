// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <string>

#include "chicane/base/result.hpp"
#include "chicane/sweep/league.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::apps {

/// A run of a league whose program is a ROS 2 controller, in real time: `chicane ros --simulate` and the
/// program, each started by a shell, in the DDS domain `domain`. `own`: this program, for a shell. Fails with
/// kIo where no command has come for `patience` [s], or the simulator could not begin; its words are in the
/// error.
[[nodiscard]] Result<telemetry::RunSummary> drive_ros_program(const sweep::ExternalTrial& trial, int domain,
                                                              const std::string& own, double patience,
                                                              const std::atomic<bool>& stop);

}  // namespace chicane::apps
