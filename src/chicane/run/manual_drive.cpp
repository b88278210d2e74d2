// SPDX-License-Identifier: MIT
#include "chicane/run/manual_drive.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace chicane::run {
namespace {

constexpr double kGentleBraking = 0.4;  // share of the useful braking, as in controller/fallback.hpp
constexpr double kFadeSpeed = 2.5;      // [m/s] below, braking fades and a negative pedal is the reverse gear

}  // namespace

void ManualDrive::set(const ManualSetting& setting) noexcept {
  switch (setting.what) {
    case ManualSetting::What::kIsOn:
      is_on_ = setting.value != 0.0;
      break;
    case ManualSetting::What::kSteer:
      steer_ = setting.value;
      break;
    case ManualSetting::What::kThrottle:
      throttle_ = setting.value;
      break;
  }
  has_news_ = true;
}

model::Command ManualDrive::command(const model::Measurement& now,
                                    const model::VehicleParams& vehicle) noexcept {
  if (std::exchange(has_news_, false)) last_set_ = now.time;
  const double speed = std::isfinite(now.speed) ? std::fabs(now.speed) : kFadeSpeed;
  const double useful = vehicle.brake_throttle_limit;
  double throttle = throttle_;
  if (now.time - last_set_ > kSilenceLimit) {
    throttle = -kGentleBraking * useful * std::min(1.0, speed / kFadeSpeed);
  } else if (throttle < 0.0 && speed >= kFadeSpeed) {
    throttle *= useful;
  }
  return {.steer = steer_ * vehicle.steer_limit, .throttle = throttle};
}

void ManualDrive::restart() noexcept {
  has_news_ = false;
  last_set_ = 0.0;
}

}  // namespace chicane::run
