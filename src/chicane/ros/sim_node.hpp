// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>

#include "chicane/base/result.hpp"
#include "chicane/ros/node_options.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/wire/simulate.hpp"

namespace chicane::ros {

/// `chicane ros --simulate`: our car and track as ROS 2 topics, in real time: odometry, transform, IMU and
/// laser scan out, drive commands in. The car waits for the first command. Each command acts
/// `scenario.latency` after it arrived; when they cease the car is stopped as `scenario.guard.receiver` says,
/// by the stop plan that came with the last one where there was one.
///
/// Uses of the scenario: track, car, plant_options, vehicle, guard.receiver, sensor, seed, laps, time_limit,
/// latency, control_period (of the odometry). Ends when the laps are driven, the car is lost, time is up, or
/// `stop` is set, with the results so far.
[[nodiscard]] Result<wire::SimulateReport> simulate(const NodeOptions& node,
                                                    const scenario::Scenario& scenario,
                                                    const wire::SimulateHooks& hooks,
                                                    const std::atomic<bool>& stop);

}  // namespace chicane::ros
