// SPDX-License-Identifier: MIT
#include "chicane/safety/stop_player.hpp"

#include <cmath>

namespace chicane::safety {
namespace {

// Of a car in full size; a model car's are shorter by the root of its scale. Chosen: a pole of 2.5
// 1/s, slower than drive and brakes follow; the speed at which Guard's car stands.
constexpr double kSpeedTime = 0.4;  // [s] in which the planned speed is met again
constexpr double kStanding = 0.5;   // [m/s] a plan that ends faster is not complete

}  // namespace

model::Command played(const StopPlan& stop, double distance, double speed,
                      const model::VehicleParams& vehicle, int* from) noexcept {
  int point = from != nullptr ? *from : 0;
  while (point + 1 < stop.size && stop.points[static_cast<std::size_t>(point + 1)].distance <= distance)
    ++point;
  if (from != nullptr) *from = point;
  const StopPoint& here = stop.points[static_cast<std::size_t>(point)];
  const StopPoint& next = stop.points[static_cast<std::size_t>(std::min(point + 1, stop.size - 1))];
  const double length = next.distance - here.distance;
  const double share = length > 1e-6 ? std::clamp((distance - here.distance) / length, 0.0, 1.0) : 0.0;
  const double size = std::sqrt(vehicle.scale);
  const bool ends_rolling = point + 1 == stop.size && here.speed >= size * kStanding;  // where the road ended
  const double planned = ends_rolling ? 0.0 : here.speed + share * (next.speed - here.speed);
  const double wanted = longitudinal_acceleration(vehicle, here.command.throttle, speed) +
                        (planned - speed) / (size * kSpeedTime);
  return {std::clamp(here.command.steer, -vehicle.steer_limit, vehicle.steer_limit),
          throttle_to_rest(vehicle, wanted, speed)};
}

StopPlayer::StopPlayer(const model::VehicleParams& vehicle, double control_period, Receiver receiver) noexcept
    : vehicle_{vehicle},
      patience_{std::max(kPatience, kPatienceInPeriods * control_period)},
      receiver_{receiver} {}

void StopPlayer::reset() noexcept {
  first_ = count_ = 0;
  last_time_ = distance_ = 0.0;
  is_stopping_ = false;
}

void StopPlayer::arrived(double time, const StopPlan& stop) noexcept {
  if (count_ == kWaiting) {
    first_ = (first_ + 1) % kWaiting;
    --count_;
  }
  Arrival& last = arrivals_[static_cast<std::size_t>((first_ + count_++) % kWaiting)];
  last.time = time;
  last.stop.size = std::clamp(stop.size, 0, StopPlan::kCapacity);
  std::copy_n(stop.points.begin(), last.stop.size, last.stop.points.begin());
}

model::Command StopPlayer::guard(const model::Command& command, double time, double speed) noexcept {
  const double before = last_time_;
  last_time_ = time;
  while (count_ > 1 && arrivals_[static_cast<std::size_t>((first_ + 1) % kWaiting)].time <= time) {
    first_ = (first_ + 1) % kWaiting;
    --count_;
    is_stopping_ = false;  // something newer acts
  }
  if (receiver_ == Receiver::kHold) return command;
  const Arrival& acting = arrivals_[static_cast<std::size_t>(first_)];
  const bool has_any = count_ > 0 && acting.time <= time;
  const bool has_plan = receiver_ == Receiver::kStopPlan && has_any && acting.stop.size > 0;
  const double begins = has_plan ? acting.stop.points[0].time : (has_any ? acting.time : 0.0) + patience_;
  if (time <= begins) {
    is_stopping_ = false;
    return command;
  }
  if (!is_stopping_) distance_ = 0.0;
  distance_ += (time - std::max(before, begins)) * std::fabs(speed);
  is_stopping_ = true;
  return has_plan ? played(acting.stop, distance_, speed, vehicle_) : brake(command, speed);
}

model::Command StopPlayer::brake(const model::Command& command, double speed) const noexcept {
  const double useful = longitudinal_acceleration(vehicle_, lowest_throttle(vehicle_, speed), speed);
  return {command.steer, throttle_to_rest(vehicle_, useful, speed)};
}

}  // namespace chicane::safety
