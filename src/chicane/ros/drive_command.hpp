// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/protocol/car_messages.hpp"
#include "chicane/ros/node_options.hpp"

namespace chicane::ros {

/// What is sent for a command that acts at `speed` [m/s]: the acceleration that it means, and the speed that
/// asks a speed controller for it, never below 0. Stamp and frame are left empty.
[[nodiscard]] protocol::DriveMessage to_message(const model::VehicleParams& vehicle,
                                                const model::Command& command, double speed,
                                                const DriveOptions& options) noexcept;

/// The pedal with which a car at `speed` [m/s] follows: its own speed controller, or the acceleration.
/// `wanted`: the message's speed [m/s] or acceleration [m/s²], as `options` say.
[[nodiscard]] double throttle_of(const model::VehicleParams& vehicle, double wanted, double speed,
                                 const DriveOptions& options) noexcept;

}  // namespace chicane::ros
