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

void ResetWatch::ask() noexcept {
  is_waiting_ = true;
  origin_ = last_;
  driven_ = asked_ = 0.0;
}

void ResetWatch::give_up() noexcept {
  is_waiting_ = false;
  silent_ = origin_;
}

bool ResetWatch::rests() const noexcept {
  const bool was_silent =
      last_.time - silent_.time < kLongest && hypot(last_.x - silent_.x, last_.y - silent_.y) < kWay;
  return last_.time - rests_since_.time > kRest && !was_silent;
}

void ResetWatch::see(const model::Measurement& now, double pedal) noexcept {
  has_answered_ = false;
  if (!std::isfinite(now.time + now.x + now.y + now.psi + now.speed)) return;
  if (has_last_ && now.time <= last_.time) return;
  has_jumped_ = has_last_ && jumps(now);
  const double elapsed = now.time - last_.time;
  if (has_jumped_) {
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
  const bool goes_on = has_last_ && now.speed < kStandingSpeed &&
                       hypot(now.x - rests_since_.x, now.y - rests_since_.y) < kRestWay &&
                       std::fabs(angle_difference(now.psi, rests_since_.psi)) < kRestTurn;
  if (!goes_on) rests_since_ = now;
  last_ = now;
  has_last_ = true;
}

}  // namespace chicane::safety
