// SPDX-License-Identifier: MIT
#include "chicane/safety/reset_watch.hpp"

#include <algorithm>
#include <cmath>

#include "chicane/base/math.hpp"

namespace chicane::safety {
namespace {

constexpr double kSpeedError = 1.5;  // times the measured speed that a car may move between two measurements
constexpr double kMemory = 0.5;      // [s] for which the car answers to a pedal

}  // namespace

bool ResetWatch::jumps(const model::Measurement& now) const noexcept {
  const double elapsed = std::max(now.time - last_.time, 0.0);
  const double driven = elapsed * std::max(now.speed, std::min(last_.speed, kStandingSpeed));
  return hypot(now.x - last_.x, now.y - last_.y) > kJump + kSpeedError * driven;
}

void ResetWatch::see(const model::Measurement& now, double pedal) noexcept {
  has_answered_ = false;
  if (!std::isfinite(now.time + now.x + now.y + now.psi + now.speed)) return;
  if (has_last_ && now.time <= last_.time) return;
  const bool has_jumped = has_last_ && jumps(now);
  const double elapsed = now.time - last_.time;
  if (has_jumped) {
    is_waiting_ = now.speed < kStandingSpeed;
    origin_ = now;
    driven_ = asked_ = 0.0;
  } else if (is_waiting_) {
    driven_ += 0.5 * elapsed * (now.speed + last_.speed);
    asked_ = (asked_ + elapsed * pedal) * kMemory / (kMemory + elapsed);
    const double dx = now.x - origin_.x;
    const double dy = now.y - origin_.y;
    const double along = dx * cos(origin_.psi) + dy * sin(origin_.psi);
    const double way = hypot(dx, dy);
    const bool agrees = std::fabs(way - driven_) < kDisagreement + kDisagreementShare * way &&
                        std::fabs(along) > (1.0 - kDisagreementShare) * way;
    has_answered_ = way > kWay && agrees && along * asked_ > 0.0;
    is_waiting_ = !has_answered_ && (agrees || way < kWay) && now.time - origin_.time < kLongest;
  }
  last_ = now;
  has_last_ = true;
}

}  // namespace chicane::safety
