// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "chicane/controller/controller.hpp"
#include "chicane/ros/node_options.hpp"
#include "chicane/wire/serve.hpp"

namespace chicane::ros {

/// `chicane ros`: wire::serve for a car that speaks ROS 2. Reads odometry, answers each with a command, and
/// publishes the run (run_publisher.hpp). Dashboard, settings and recording are those of `serve`.
///
/// A control cycle begins with odometry, at most one each 0.75 control periods. Where none comes in time the
/// cycle is one in which nothing was measured, and the guard decides; after kAbsence of that cycles end until
/// odometry comes again. The car is stopped by the stop at hand when TopicNames::stop says so, and drives on
/// from rest alone.
///
/// Uses of the options: track, lap, scenario, step_budget, forget_after, silent_after, server (dashboard).
/// kIo when DDS or the port fails.
[[nodiscard]] Result<wire::ServeSummary> drive(const NodeOptions& node, const wire::ServeOptions& options,
                                               std::unique_ptr<controller::Controller> controller,
                                               wire::ServeHooks hooks, wire::Endpoint* viewer,
                                               std::vector<net::Asset> assets, const std::atomic<bool>& stop);

}  // namespace chicane::ros
