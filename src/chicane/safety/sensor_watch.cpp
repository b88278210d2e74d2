// SPDX-License-Identifier: MIT
#include "chicane/safety/sensor_watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "chicane/base/math.hpp"

namespace chicane::safety {
namespace {

// Origins (chosen: by trial, see Guard):
// - Derived: kDeviations (one in two million of a normal distribution), kDrift (MeasurementMonitor's
//   kKnownDrift), kMostCalm (twice kCalmTime), kWalking (Guard's kLedBackSpeed).
// - Measured: kPlaceStep, kHeadingStep, kSpeedStep: calm cars differ by 0.10 m, 0.061 rad, 1.2 m/s at most;
//   kSum, kSumWay, kSumShare, kSumDeviations: these cars reach 0.46 of (11) at most (five presets on
//   lakeside and hairpins, also with latency_jitter_ms=60, perfect sensors).
// - Chosen, docs/guard.md: kWindows, kMostSlip, kCrab, kTurned, kTurnedShare (eq. 11), kLearned, kLatest,
//   kMostLag, kRetry ("Late measurements").
// - Chosen, for what their lines say: kMostDrift, kUnrest, kTried, kSilence; and coarse, half or double
//   passes each test of this module: kBlindDrift, kSpeedDrift, kHeadingDrift, kMostHeadingDrift, kStill,
//   kMoving, kLongestStep.
constexpr double kPlaceStep = 0.25;    // [m] a calm car in full size is not farther from where it is expected
constexpr double kHeadingStep = 0.06;  // [rad] the same of its heading
constexpr double kSpeedStep = 1.0;     // [m/s] and of its speed
constexpr double kDeviations = 5.0;    // of noise that are added to each
constexpr std::array<double, 3> kWindows{1.0, 3.0, 10.0};  // [s] over which motions are compared
constexpr double kSum = 0.1;               // [m] by which they may differ, for a car in full size
constexpr double kSumShare = 0.005;        // and of the way driven in a second, times the root of the time
constexpr double kSumDeviations = 2.0;     // and of what they have differed by before
constexpr double kTurned = 0.1;            // [rad] by which a heading turns otherwise than the wheels ask for
constexpr double kTurnedShare = 0.4;       // and of that turning
constexpr double kDrift = 0.012;           // of the way, by speed and heading
constexpr double kBlindDrift = 0.1;        // of the way, by the model alone
constexpr double kMostDrift = 3.0;         // [m] by which a place may differ that is accepted again
constexpr double kSpeedDrift = 2.0;        // [m/s²] of the expected speed while it is not measured
constexpr double kHeadingDrift = 0.03;     // [rad/s] of the expected heading
constexpr double kMostHeadingDrift = 0.1;  // [rad]
constexpr double kLatest = 1.6;       // [s] age of a measurement that can be distinguished from another place
constexpr double kMostCalm = 4.0;     // [s] of calm that are remembered
constexpr double kUnrest = 0.5;       // [s] of them that one restless measurement costs
constexpr double kTried = 1.0;        // [m/s] at which a car answers to its pedal late or in time
constexpr double kMostLag = 0.2;      // [s] by which it may
constexpr double kRetry = 10.0;       // [s] after which it is tried again
constexpr double kSilence = 0.2;      // [s] without a measurement, after which a car is not sure of its place
constexpr double kMostSlip = 1.2;     // share of the estimated slip that a car may lack
constexpr double kWalking = 6.0;      // [m/s] a slower car, in full size, may be on its way back to the road
constexpr double kCrab = 0.12;        // [rad] by which wind may push a car off its heading
constexpr double kSumWay = 0.003;     // of the way, by which its length may differ
constexpr double kStill = 0.3;        // [m/s]
constexpr double kMoving = 2.0;       // [m/s] a slower car, in full size, looks like itself earlier
constexpr double kLongestStep = 0.5;  // [s]
constexpr int kLearned = 200;         // innovations of which the noise is the mean

/// Place of a measurement or a state [m].
Vec2 place_of(const auto& at) noexcept { return {at.x, at.y}; }

}  // namespace

void SensorWatch::Noise::learn(double innovation) noexcept {
  count = std::min(count + 1, kLearned);
  square += (innovation * innovation - square) / count;
}

double SensorWatch::Noise::deviation() const noexcept { return std::sqrt(square); }

SensorWatch::SensorWatch(double length, double wheelbase) noexcept
    : size_{std::min(length / kFullSize, 1.0)}, wheelbase_{wheelbase} {}

void SensorWatch::reset(bool forgets_lateness) noexcept {
  SensorWatch watch{size_ * kFullSize, wheelbase_};
  watch.doubts_.late = !forgets_lateness && (doubts_.late || is_tried_);
  watch.retry_ = retry_;
  *this = watch;
}

const SensorWatch::Sample& SensorWatch::back(std::size_t count) const noexcept {
  return samples_[(count_ - 1 - count) % kSamples];
}

/// What an innovation is below, of a car that is measured calmly.
SensorWatch::Innovation SensorWatch::limits() const noexcept {
  return {
      .place = kPlaceStep * size_ + kDeviations * place_.deviation() + std::min(drift_, kMostDrift * size_),
      .heading = kHeadingStep + kDeviations * heading_.deviation() +
                 std::min(kHeadingDrift * unseen_, kMostHeadingDrift),
      .speed = kSpeedStep * std::sqrt(size_) + kDeviations * speed_.deviation() + kSpeedDrift * unseen_};
}

const SensorDoubts& SensorWatch::see(const model::Measurement& now, const model::State& expected) noexcept {
  const double elapsed = now.time - time_;
  if (!has_last_ || !(elapsed > 0.0)) {
    if (!has_last_) add_sample(now, expected);
    last_ = now;
    time_ = now.time;
    estimated_speed_ = std::fabs(now.speed);
    has_last_ = true;
    return doubts_;
  }
  count_on(elapsed, now, expected);
  if (elapsed > kSilence) {
    if (!has_doubts()) calm_ = 0.0;
    clean_from_ = now.time;
  }
  const Innovation seen{
      .place = (place_of(now) - (doubts_.place ? counted_place_ : place_of(expected))).norm(),
      .heading = std::fabs(angle_difference(now.psi, expected.psi)),
      .speed = std::fabs(std::fabs(now.speed) - hypot(expected.vx, expected.vy))};
  const Innovation most = limits();
  // Where a command that acts late turns the car by more than (10), its heading is not known well enough.
  const double rate = expected.vx * tan(expected.steer) / wheelbase_;
  if (std::fabs(rate - std::exchange(asked_rate_, rate)) * kLateCommand > most.heading) calm_ = 0.0;
  const bool is_judged = is_sure() || doubts_.place || doubts_.heading || doubts_.speed;
  if (is_judged || doubts_.late) {
    end_doubts(seen, most, elapsed, angle_difference(now.psi, expected.psi));
    judge_age(now, expected, seen, most, elapsed);
    const bool was_doubted = doubts_.place;
    if (is_judged && !doubts_.is_old) begin_doubts(seen, most);
    if (place_confirms_speed(elapsed, now, expected)) doubts_.speed = false;
    if (doubts_.place && !was_doubted) {
      has_jumped_ = true;
      counted_place_ = place_of(expected);
    }
  }
  try_start(now, expected, elapsed);
  if (!has_doubts()) {
    learn(seen, most, elapsed);
    if (!is_sure()) clean_from_ = now.time - calm_;
    if (calm_ > kCalmTime) judge_sums(now);
  }
  if (!doubts_.place) counted_place_ = place_of(now);
  unseen_ = has_doubts() ? unseen_ + elapsed : 0.0;
  if (has_doubts())
    clean_from_ = now.time;
  else
    drift_ = 0.0;
  add_sample(now, expected);
  last_ = now;
  time_ = now.time;
  estimated_speed_ = doubts_.speed || doubts_.is_old ? hypot(expected.vx, expected.vy) : std::fabs(now.speed);
  return doubts_;
}

/// docs/guard.md, eq. 10a: the place, which does not depend on the speed, has moved by the measured speed and
/// not by the expected one. Then the model is wrong, not the sensor.
bool SensorWatch::place_confirms_speed(double elapsed, const model::Measurement& now,
                                       const model::State& expected) const noexcept {
  if (doubts_.place || doubts_.is_old) return false;
  const double modelled = estimated_speed_ + hypot(expected.vx, expected.vy);
  const double apart = 0.5 * elapsed * (std::fabs(last_.speed) + std::fabs(now.speed) - modelled);
  const double noise = kDeviations * length_.deviation();
  const double longer = std::copysign(longer_, longer_ * apart);
  return std::fabs(apart) > 2.0 * noise && longer > -0.5 * std::fabs(apart) &&
         longer < std::fabs(apart) + noise;
}

/// The way that speed and heading describe, and where the car is by it.
void SensorWatch::count_on(double elapsed, const model::Measurement& now,
                           const model::State& expected) noexcept {
  const double slip_now = atan2(expected.vy, std::max(expected.vx, kMoving * size_));
  const double slip = 0.5 * (std::exchange(slip_, slip_now) + slip_now);
  const double turn = angle_difference(now.psi, last_.psi);
  const double course = last_.psi + 0.5 * turn + slip;
  const double way = 0.5 * elapsed * (std::fabs(now.speed) + std::fabs(last_.speed));
  const Vec2 step = way * Vec2{cos(course), sin(course)}, moved = place_of(now) - place_of(last_);
  moved_ = (moved - step).norm();
  longer_ = moved.norm() - way;
  driven_ += way;
  way_ += step;
  slip_way_ += step - way * Vec2{cos(course - slip), sin(course - slip)};
  turned_ += turn;
  asked_ += elapsed * expected.vx * tan(expected.steer) / wheelbase_;
  const bool is_blind = doubts_.is_old || doubts_.heading || doubts_.speed;
  drift_ += (is_blind ? kBlindDrift : kDrift) * elapsed * expected.vx;
  if (!doubts_.place) return;
  // After a jump the estimate counts on by itself. Its slip must not come back to it as a measured place.
  counted_place_ = is_blind || has_jumped_ ? place_of(expected) : counted_place_ + step;
}

void SensorWatch::add_sample(const model::Measurement& now, const model::State& expected) noexcept {
  if (count_ > 0 && now.time - back(0).time < kSpacing) return;
  samples_[count_ % kSamples] = {now.time,  place_of(now), driven_, way_,
                                 slip_way_, turned_,       asked_,  expected};
  ++count_;
}

void SensorWatch::learn(const Innovation& seen, const Innovation& most, double elapsed) noexcept {
  const bool is_calm = seen.place < 0.5 * most.place && seen.heading < 0.5 * most.heading &&
                       seen.speed < 0.5 * most.speed && elapsed < kLongestStep;
  if (std::fabs(last_.speed) < kWalking * std::sqrt(size_)) {
    calm_ = std::max(calm_ - elapsed, 0.0);
    return;
  }
  calm_ = is_calm ? std::min(calm_ + elapsed, kMostCalm) : std::max(calm_ - kUnrest, 0.0);
  if (!(elapsed < kLongestStep)) {
    calm_ = 0.0;
    return;
  }
  place_.learn(std::min(seen.place, kPlaceStep * size_));
  heading_.learn(std::min(seen.heading, kHeadingStep));
  speed_.learn(std::min(seen.speed, kSpeedStep * std::sqrt(size_)));
  length_.learn(std::min(std::fabs(longer_), kPlaceStep * size_));
}

/// A measurement of an earlier moment, and those that go on from it, say nothing of now. Their doubt ends
/// when measurements of now have come for kAgreeing, or the car stands.
void SensorWatch::judge_age(const model::Measurement& now, const model::State& expected,
                            const Innovation& seen, const Innovation& most, double elapsed) noexcept {
  const bool stands = std::fabs(now.speed) < kStill && expected.vx < kStill;
  const bool goes_on =
      doubts_.is_old && !stands && moved_ < kPlaceStep * size_ + kDeviations * place_.deviation();
  const bool is_far = seen.place > most.place;
  doubts_.is_old = goes_on || (is_far && !doubts_.place && is_earlier(now, most));
  doubts_.late |= doubts_.is_old;
  // A place in doubt stays far. The place of a standing or slow car does not show the age of a measurement.
  const bool is_other = is_far && !(stands && doubts_.place);
  const bool is_slow = !stands && std::fabs(now.speed) * kMostLag < most.place;
  late_agrees_ = doubts_.is_old || is_other ? 0.0 : late_agrees_ + (is_slow ? 0.0 : elapsed);
  const bool must_wait = retry_ > 0.0 && (!stands || (now.time < retry_ && now.time > retry_ - kRetry));
  if (!doubts_.late || late_agrees_ < kAgreeing || must_wait) return;
  doubts_.late = false;
  is_tried_ = stands;
  asked_speed_ = lag_ = 0.0;
}

/// A car that stood while measurements were late is watched as it starts: whether they are shows there.
void SensorWatch::try_start(const model::Measurement& now, const model::State& expected,
                            double elapsed) noexcept {
  if (!is_tried_) return;
  asked_speed_ = std::max(0.0, asked_speed_ + expected.vx - std::fabs(last_.speed));
  const double tried = kTried * std::sqrt(size_);
  if (asked_speed_ > tried) lag_ += elapsed;
  if (lag_ > kMostLag) {
    doubts_.late = doubts_.is_old = true;
    retry_ = now.time + kRetry;
  }
  if (doubts_.late || std::fabs(now.speed) > tried) is_tried_ = false;
  if (!doubts_.late && !is_tried_) retry_ = 0.0;
}

void SensorWatch::begin_doubts(const Innovation& seen, const Innovation& most) noexcept {
  doubts_.speed |= seen.speed > most.speed;
  doubts_.heading |= seen.heading > most.heading;
  doubts_.place |= seen.place > most.place;
}

/// Whether it was measured where the car was in the last kLatest, as it was then.
bool SensorWatch::is_earlier(const model::Measurement& now, const Innovation& most) const noexcept {
  const double near = kPlaceStep * size_ + kDeviations * place_.deviation() + 0.3 * drift_;
  const std::size_t have = std::min(count_, kSamples);
  for (std::size_t i = 0; i + 1 < have && now.time - back(i).time < kLatest; ++i) {
    const model::State& later = back(i).estimated;
    const model::State& earlier = back(i + 1).estimated;
    const Vec2 step = place_of(later) - place_of(earlier), from = place_of(now) - place_of(earlier);
    const double square = step.squared_norm();
    const double share = square > 0.0 ? std::clamp(from.dot(step) / square, 0.0, 1.0) : 0.0;
    const double away = (from - share * step).norm();
    const double psi = earlier.psi + share * angle_difference(later.psi, earlier.psi);
    const double speed =
        hypot(earlier.vx, earlier.vy) + share * (hypot(later.vx, later.vy) - hypot(earlier.vx, earlier.vy));
    if (away < near && std::fabs(angle_difference(now.psi, psi)) < most.heading &&
        std::fabs(std::fabs(now.speed) - speed) < most.speed)
      return true;
  }
  return false;
}

/// Equation 11: the motion over up to 10 s by the place against that by speed and heading.
void SensorWatch::judge_sums(const model::Measurement& now) noexcept {
  const std::size_t have = std::min(count_, kSamples);
  std::size_t i = 0;
  for (std::size_t k = 0; k < kWindows.size(); ++k) {
    while (i + 1 < have && back(i + 1).time >= clean_from_ && now.time - back(i).time < kWindows[k]) ++i;
    const Sample& from = back(i);
    const double elapsed = now.time - from.time;
    if (elapsed < 0.9 * kWindows[k]) return;
    const Vec2 way = way_ - from.way, off = place_of(now) - from.place - way;
    // A car that is measured elsewhere than at its centre of mass slips differently there.
    const Vec2 slip = slip_way_ - from.slip;
    const double square = slip.squared_norm();
    const double share = square > 0.0 ? std::clamp(-off.dot(slip) / square, 0.0, kMostSlip) : 0.0;
    // Wind turns the course off the heading, and leaves the length of the way as it is.
    const Vec2 left = off + share * slip;
    const double length = way.norm(), longer = (way + left).norm() - length;
    const double aside = length > 0.0 ? std::fabs(left.y() * way.x() - left.x() * way.y()) / length : 0.0;
    const double sum = hypot(longer, std::max(aside - kCrab * length, 0.0));
    const double speed = (driven_ - from.driven) / elapsed;
    const double most = kSum * size_ + kSumShare * speed * std::sqrt(elapsed) + kSumWay * length +
                        kSumDeviations * sums_[k].deviation() + kDeviations * place_.deviation();
    if (sum < 0.5 * most) sums_[k].learn(sum);
    if (!(sum > most)) continue;
    const double asked = asked_ - from.asked;
    if (std::fabs(turned_ - from.turned - asked) > kTurned + kTurnedShare * std::fabs(asked)) {
      doubts_.heading = true;
    } else {
      doubts_.place = true;
      has_jumped_ = false;
      counted_place_ = place_of(now) - off;
    }
    return;
  }
}

void SensorWatch::end_doubts(const Innovation& seen, const Innovation& most, double elapsed,
                             double turned) noexcept {
  const auto ends = [&](bool& doubt, double& agrees, bool is_there) {
    agrees = is_there ? agrees + elapsed : 0.0;
    if (agrees > kAgreeing) doubt = false;
  };
  if (heading_agrees_ == 0.0) agreed_heading_ = turned;
  const bool turns_alike =
      std::fabs(turned - agreed_heading_) < 0.5 * kHeadingStep + kDeviations * heading_.deviation();
  const bool moves_alike = moved_ < kPlaceStep * size_ + kDeviations * place_.deviation();
  ends(doubts_.place, place_agrees_, seen.place < most.place && moves_alike);
  ends(doubts_.heading, heading_agrees_, seen.heading < most.heading && turns_alike);
  ends(doubts_.speed, speed_agrees_, seen.speed < most.speed);
}

}  // namespace chicane::safety
