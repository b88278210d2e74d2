// SPDX-License-Identifier: MIT
#include "chicane/ros/drive_command.hpp"

#include <algorithm>

namespace chicane::ros {

protocol::DriveMessage to_message(const model::VehicleParams& vehicle, const model::Command& command,
                                  double speed, const DriveOptions& options) noexcept {
  protocol::DriveMessage message;
  message.steer = command.steer;
  message.acceleration = model::longitudinal_acceleration(vehicle, command.throttle, speed);
  message.speed = std::max(0.0, speed + options.speed_lead * message.acceleration);
  return message;
}

double throttle_of(const model::VehicleParams& vehicle, double wanted, double speed,
                   const DriveOptions& options) noexcept {
  const double acceleration = options.is_by_speed ? (wanted - speed) / options.speed_lead : wanted;
  const bool is_coming_to_rest = options.is_by_speed && wanted <= 0.0 && acceleration < 0.0;
  return is_coming_to_rest ? model::throttle_to_rest(vehicle, acceleration, speed)
                           : model::throttle_for(vehicle, acceleration, speed);
}

}  // namespace chicane::ros
