// SPDX-License-Identifier: MIT
#include "chicane/safety/measurement_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "chicane/base/math.hpp"

namespace chicane::safety {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// Origins (chosen: by trial, see Guard):
// - Derived: kJumpBack (ResetWatch::kJump).
// - Chosen, docs/guard.md: kMismatch, kMismatchShare (eq. 8), kLongFrozen ("Frozen").
// - Chosen: kLongestGap (a dozen cycles), kBlindSpeedDrift (half of what cars brake).
constexpr double kLongestGap = 0.5;       // [s] between measurements that say anything of each other
constexpr double kMismatch = 2.0;         // [m] between displacement and integrated speed
constexpr double kMismatchShare = 0.3;    // and of the larger one
constexpr double kBlindSpeedDrift = 6.0;  // [m/s²] error of the expected speed without measurements
constexpr double kLongFrozen = 0.2;       // [s] after which what was doubted before says nothing any more
constexpr double kJumpBack = 1.0;         // [m] otherwise than the car moved, between two measurements

}  // namespace

void MeasurementMonitor::reset(bool forgets_lateness) noexcept {
  watch_.reset(forgets_lateness);
  *this = MeasurementMonitor{watch_};
}

const model::Measurement& MeasurementMonitor::check(const model::Measurement& now,
                                                    const model::State* expected) noexcept {
  const bool was_frozen = findings_.frozen && now.time - thawed_ > kLongFrozen;
  if (!findings_.frozen) thawed_ = now.time;
  const double elapsed = has_last_ ? now.time - last_.time : 0.0;
  const bool is_later = std::isfinite(now.time) && (!has_last_ || elapsed > 0.0);
  const bool is_whole = is_later && std::isfinite(now.x) && std::isfinite(now.y) && std::isfinite(now.psi) &&
                        std::isfinite(now.speed);
  constexpr Signals kAll{true, true, true};
  findings_ = {.unmeasured = !is_whole};
  if (!is_later) return checked_ = without(now, kAll);
  findings_.frozen = is_whole && is_frozen(now, elapsed);
  const bool is_judged = expected != nullptr && is_whole && !findings_.frozen;
  if (is_judged)
    judge(now, *expected, elapsed, was_frozen);
  else
    own_ = findings_;
  const bool is_old = findings_.late && watch_.doubts().is_old;
  const bool is_blind = !is_whole || findings_.frozen || is_old;
  count_drift(is_blind, elapsed, expected != nullptr ? hypot(expected->vx, expected->vy) : 0.0);
  if (is_whole) last_ = now;
  last_.time = now.time;
  has_last_ |= is_whole;
  if (!is_whole) sample_count_ = 0;
  const Signals wrong{findings_.position_jump, findings_.heading_jump, findings_.speed_mismatch};
  checked_ = without(now, findings_.frozen || is_old ? kAll : wrong);
  const bool counts_on = is_judged && !is_blind && watch_.doubts().place && !wrong.heading && !wrong.speed;
  if (counts_on && watch_.place().x() != expected->x) {
    checked_.x = watch_.place().x();
    checked_.y = watch_.place().y();
  }
  return checked_;
}

/// Equations 7 and 8, and what the watch doubts.
void MeasurementMonitor::judge(const model::Measurement& now, const model::State& expected, double elapsed,
                               bool was_frozen) noexcept {
  const Findings before = std::exchange(own_, {});
  const double speed = hypot(expected.vx, expected.vy);
  const double step = std::min(elapsed, kLongestGap);
  // A place that jumped is right again when it jumps back, not when the estimate has drifted up to it.
  own_.position_jump =
      hypot(now.x - expected.x, now.y - expected.y) > kJump + kAcceleration * step * step + place_drift_ ||
      (before.position_jump && !jumps(now, elapsed));
  // A displacement to a place that jumped, or back, says nothing of the speed.
  if (own_.position_jump || before.position_jump) sample_count_ = 0;
  own_.speed_mismatch = std::fabs(now.speed - speed) > kSpeedJump + kAcceleration * step + other_drift_ ||
                        contradicts_displacement(now, elapsed) ||
                        // A speed that was wrong is right again when it says so of a car that moves.
                        (before.speed_mismatch && now.speed < kMoving);
  // Where place and speed are both wrong, the heading comes from the same wrong sensor.
  own_.heading_jump = std::fabs(angle_difference(now.psi, expected.psi)) >
                          kHeadingJump + kYawAcceleration * step * step + 0.1 * other_drift_ ||
                      (own_.position_jump && own_.speed_mismatch);
  findings_ = own_;
  findings_.frozen = is_stuck(now, expected);
  if (findings_.frozen) return;
  if (was_frozen) watch_.forget_doubts();
  const SensorDoubts& doubts = watch_.see(now, expected);
  if (doubts.is_old) own_ = {};
  findings_ = {.late = doubts.late,
               .speed_mismatch = own_.speed_mismatch || doubts.speed,
               .heading_jump = own_.heading_jump || doubts.heading,
               .position_jump = own_.position_jump || doubts.place};
}

/// While a signal is missing, the estimate of a car of this speed [m/s] drifts away from the car.
void MeasurementMonitor::count_drift(bool is_blind, double elapsed, double speed) noexcept {
  const double driven = elapsed * speed;
  const double share = is_blind ? kBlindDrift : kKnownDrift;
  place_drift_ = is_blind || findings_.position_jump ? place_drift_ + share * driven : 0.0;
  other_drift_ = is_blind ? other_drift_ + kBlindSpeedDrift * std::min(elapsed, kLongestGap) : 0.0;
}

/// `now` without the signals named in `missing`.
model::Measurement MeasurementMonitor::without(model::Measurement now, const Signals& missing) noexcept {
  if (missing.place) now.x = now.y = kNaN;
  if (missing.heading) now.psi = kNaN;
  if (missing.speed) now.speed = kNaN;
  return now;
}

bool MeasurementMonitor::is_frozen(const model::Measurement& now, double elapsed) noexcept {
  const bool is_same = has_last_ && elapsed < kLongestGap && now.x == last_.x && now.y == last_.y &&
                       now.psi == last_.psi && now.speed == last_.speed;
  if (!is_same) same_since_ = now.time;
  return now.speed * (now.time - same_since_) > kUnmoved;
}

/// Whether each signal is in doubt or repeats to the last bit, some of both, although the car moves or says
/// so: they come from one sensor that is stuck, with noise or an offset on some of them. It is as long as
/// those repeat.
bool MeasurementMonitor::is_stuck(const model::Measurement& now, const model::State& expected) noexcept {
  const Signals repeat{has_last_ && now.x == last_.x && now.y == last_.y, has_last_ && now.psi == last_.psi,
                       has_last_ && now.speed == last_.speed};
  if (stuck_.any()) {
    const bool goes_on = (repeat.place || !stuck_.place) && (repeat.heading || !stuck_.heading) &&
                         (repeat.speed || !stuck_.speed);
    if (!goes_on) stuck_ = {};
    return goes_on;
  }
  const SensorDoubts& doubts = watch_.doubts();
  const Signals doubted{findings_.position_jump || doubts.place, findings_.heading_jump || doubts.heading,
                        findings_.speed_mismatch || doubts.speed};
  const bool moves = std::max(hypot(expected.vx, expected.vy), now.speed) > kMoving;
  const bool covers_all = (doubted.place || repeat.place) && (doubted.heading || repeat.heading) &&
                          (doubted.speed || repeat.speed);
  const bool is_doubled =
      repeat.place && repeat.heading && repeat.speed && now.speed > kMoving;  // is_frozen()
  if (moves && covers_all && doubted.any() && !doubts.late && !is_doubled)
    stuck_ = {repeat.place && !doubted.place, repeat.heading && !doubted.heading,
              repeat.speed && !doubted.speed};
  return stuck_.any();
}

/// Whether the measured place has moved otherwise than the car did since the last measurement.
bool MeasurementMonitor::jumps(const model::Measurement& now, double elapsed) const noexcept {
  if (!has_last_ || !(elapsed < kLongestGap)) return true;
  const double driven = 0.5 * elapsed * (now.speed + last_.speed);
  const double x = now.x - last_.x - driven * cos(now.psi), y = now.y - last_.y - driven * sin(now.psi);
  return hypot(x, y) > kJumpBack + kMismatchShare * driven;
}

/// Equation 8: over the last second, or what there is of it. A way that bends is longer than the
/// displacement.
bool MeasurementMonitor::contradicts_displacement(const model::Measurement& now, double elapsed) noexcept {
  if (!has_last_ || elapsed > kLongestGap) sample_count_ = 0;
  if (sample_count_ == 0) {
    driven_ = 0.0;
    way_ = {};
  } else {
    const double driven = 0.5 * elapsed * (now.speed + last_.speed);
    const double heading = now.psi + 0.5 * angle_difference(last_.psi, now.psi);
    driven_ += driven;
    way_ += driven * Vec2{cos(heading), sin(heading)};
  }
  // A jump of the place would look like a speed.
  const bool has_jumped =
      sample_count_ > 0 && hypot(now.x - last_.x, now.y - last_.y) >
                               kJump + (now.speed + last_.speed) * elapsed + kAcceleration * elapsed;
  if (has_jumped) sample_count_ = 0;
  bool is_wrong = false;
  if (sample_count_ > 0) {
    const Sample& first = samples_[0];
    const double displacement = (Vec2{now.x, now.y} - first.place).norm();
    const double driven = driven_ - first.driven;
    const double chord = (way_ - first.way).norm();
    const double tolerance = kMismatch + kMismatchShare * std::max(displacement, driven);
    is_wrong = displacement > driven + tolerance || displacement < chord - tolerance;
  }
  const auto last = static_cast<std::size_t>(std::max(sample_count_ - 1, 0));
  if (sample_count_ == 0 || now.time - samples_[last].time >= kSampleSpacing) {
    if (sample_count_ == kSamples) {
      std::move(samples_.begin() + 1, samples_.end(), samples_.begin());
      --sample_count_;
    }
    samples_[static_cast<std::size_t>(sample_count_++)] = {now.time, {now.x, now.y}, driven_, way_};
  }
  return is_wrong;
}

namespace {

// Origins (chosen: by trial, see Guard):
// - Chosen, for what their lines say, and coarse: half or double passes each test of this module.
constexpr double kSpeedError = 1.5;  // times the measured speed that a car may move between two measurements
constexpr double kMemory = 0.5;      // [s] for which the car answers to a pedal
constexpr double kStill = 0.05;      // [m/s] of a car that stands or turns round

}  // namespace

bool ResetWatch::jumps(const model::Measurement& now) const noexcept {
  const double elapsed = std::max(now.time - last_.time, 0.0);
  const double driven = elapsed * std::max(now.speed, std::min(last_.speed, kStandingSpeed));
  return hypot(now.x - last_.x, now.y - last_.y) > kJump + kSpeedError * driven;
}

void ResetWatch::ask() noexcept {
  is_waiting_ = true;
  origin_ = asked_at_ = last_;
  driven_ = asked_ = 0.0;
}

void ResetWatch::give_up() noexcept {
  is_waiting_ = false;
  silent_ = asked_at_;
}

bool ResetWatch::rests() const noexcept {
  const double away = hypot(last_.x - silent_.x, last_.y - silent_.y);
  const bool stayed = away < kDisagreement && last_.time - silent_.time < kLongest;
  return last_.time - rests_since_.time > kRest && !stayed;
}

void ResetWatch::see(const model::Measurement& now, double pedal) noexcept {
  has_answered_ = has_jumped_ = false;
  if (!std::isfinite(now.time) || !now.is_finite()) return;
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
    if (now.speed < kStill) {  // a car that turns round drives its way from here
      origin_ = {.time = origin_.time, .x = now.x, .y = now.y, .psi = now.psi};
      driven_ = 0.0;
    }
    const double dx = now.x - origin_.x, dy = now.y - origin_.y;
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
