// SPDX-License-Identifier: MIT
#include "chicane/run/manual_drive.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

namespace chicane::run {
namespace {

constexpr double kGentleBraking = 0.4;  // share of the useful braking, as in controller/fallback.hpp
constexpr double kFadeSpeed = 2.5;      // [m/s] below, braking fades and a negative pedal is the reverse gear

double share_of(std::string_view text) noexcept {
  double value = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return std::isfinite(value) ? std::clamp(value, -1.0, 1.0) : 0.0;
}

}  // namespace

bool ManualDrive::apply(const telemetry::Change& change) noexcept {
  const std::string_view name = change.name.view();
  const std::string_view value = change.value.view();
  if (name == "manual.is_on") {
    is_on_ = value == "true";
  } else if (name == "manual.steer") {
    steer_ = share_of(value);
  } else if (name == "manual.throttle") {
    throttle_ = share_of(value);
  } else {
    return false;
  }
  has_spoken_ = true;
  return true;
}

model::Command ManualDrive::wish(const model::Measurement& now,
                                 const model::VehicleParams& vehicle) noexcept {
  if (std::exchange(has_spoken_, false)) last_word_ = now.time;
  const double speed = std::isfinite(now.speed) ? std::fabs(now.speed) : kFadeSpeed;
  const double useful = vehicle.brake_throttle_limit;
  double throttle = throttle_;
  if (now.time - last_word_ > kPatience) {
    throttle = -kGentleBraking * useful * std::min(1.0, speed / kFadeSpeed);
  } else if (throttle < 0.0 && speed >= kFadeSpeed) {
    throttle *= useful;
  }
  return {.steer = steer_ * vehicle.steer_limit, .throttle = throttle};
}

void ManualDrive::restart() noexcept {
  has_spoken_ = false;
  last_word_ = 0.0;
}

}  // namespace chicane::run
