// SPDX-License-Identifier: MIT
#include "chicane/safety/actuator_watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/safety/sensor_watch.hpp"

namespace chicane::safety {
namespace {

// Origins (chosen: by trial, see Guard):
// - Derived: kSpacing (just below the cycle of a sensor of 100 Hz), kAngleNoise (kBand), kLongestStep (six
//   cycles of 25 Hz).
// - Measured: the band of (12) with all its terms, and kWeak: cars as configured use 0.68 of the band at
//   most, and their brakes give 0.77 at least (runs as in sensor_watch.cpp); with noise of 0.1 m, 0.5° and
//   0.1 m/s 0.54 and 0.72, which the deviations cover.
// - Chosen, docs/guard.md: kShort, kLong, kMostUse, kSpareUse, kMostSideslip, kSlides, kCalmFor,
//   kDiffersFor, kDeviations, kMemory, kGainPrior, kOffsetPrior, kUsualGain, kBraked (eq. 12, 13), kWeakFor
//   (docs/safety.md).
// - Chosen: kMostOffset (twice the ±7° of the attacks), kUsualOffset (above kBand); for what their lines
//   say: kStrong, kParts; and coarse, half or double passes each test of this module: kLearned,
//   kLeastLearned, kBrakingTime, kLeastShare.
constexpr double kShort = 0.12;         // [s] over which the car's motion is averaged
constexpr double kLong = 0.4;           // [s] the same for noisy sensors, and of braking
constexpr double kSpacing = 0.0095;     // [s] at least between samples: they reach half a second back
constexpr double kLongestStep = 0.25;   // [s] between measurements that are compared
constexpr double kMostUse = 0.75;       // share of the tyres' peak slip beyond which grip is in question
constexpr double kSpareUse = 0.35;      // of it, up to which grip is not in question
constexpr double kMostSideslip = 0.12;  // [rad]
constexpr double kSlides = 0.08;        // [rad] of a course that is another one than a car that grips has
constexpr double kCalmFor = 0.5;        // [s] after a slide, until the steering is judged again
constexpr double kDiffersFor = 0.05;    // [s] out of its band before an answer counts as another one
constexpr double kDeviations = 5.0;     // of the noise, added to the band
constexpr double kLearned = 4.0;        // [s] of which the noise is the mean
constexpr double kLeastLearned = 1.0;   // [s] of it before anything is judged
constexpr double kMemory = 3.0;         // [s] of which the answer is estimated
constexpr double kGainPrior = 0.5;      // standard deviation that is assumed of a gain
constexpr double kOffsetPrior = 0.1;    // [rad] and of an offset
constexpr double kAngleNoise = 0.01;    // [rad] of a mean angle
constexpr double kMostOffset = 0.25;    // [rad]
constexpr double kUsualGain = 0.25;  // most deviation of wheels that follow; others miss commands, or stick
constexpr double kUsualOffset = 0.012;  // [rad]
constexpr double kBraked = 0.25;        // of the useful braking, from which brakes are judged
constexpr double kWeakFor = 0.12;       // [s]
constexpr double kBrakingTime = 0.3;    // [s] in which an estimate of the braking follows
constexpr double kLeastShare = 0.2;
constexpr double kStrong = 0.9;  // share of the braking from which brakes are usual again
constexpr int kParts = 4;        // of a step, in which the command may change

}  // namespace

model::VehicleParams without_name(model::VehicleParams vehicle) noexcept {
  vehicle.name.clear();
  return vehicle;
}

ActuatorWatch::ActuatorWatch(const model::VehicleParams& vehicle) noexcept
    : model_{without_name(vehicle)}, pace_{std::sqrt(std::min(vehicle.length / kFullSize, 1.0))} {}

void ActuatorWatch::reset() noexcept { *this = ActuatorWatch{model_.vehicle()}; }

void ActuatorWatch::set_vehicle(const model::VehicleParams& vehicle) noexcept {
  model_.set_vehicle(without_name(vehicle));
}

void ActuatorWatch::see(const model::Measurement& now, const tracking::CommandHistory& sent,
                        const AxleUse& use) noexcept {
  use_ = use;
  const double elapsed = count_ > 0 ? now.time - back(0).time : 0.0;
  if (elapsed > 0.0 && elapsed < kSpacing * pace_) return;
  if (count_ > 0 && !(elapsed > 0.0 && elapsed < kLongestStep)) count_ = 0;
  add_sample(now, sent);
  if (count_ < 2) {
    for (Window& window : windows_) window.slide = window.differs_for = window.calm_for = 0.0;
    weak_for_ = 0.0;
    return;
  }
  const double seen_for = now.time - back(std::min(count_, kSamples) - 1).time;
  if (!(now.speed > kSlowest * pace_)) {
    windows_[0].differs_for = windows_[1].differs_for = weak_for_ = 0.0;
    return;
  }
  if (seen_for > kShort * pace_) judge_steering(windows_[0], kShort * pace_, elapsed);
  if (!(seen_for > kLong * pace_)) return;
  judge_steering(windows_[1], kLong * pace_, elapsed);
  judge_braking(elapsed);
}

void ActuatorWatch::add_sample(const model::Measurement& now, const tracking::CommandHistory& sent) noexcept {
  Sample next{.time = now.time, .turned = now.psi, .speed = std::fabs(now.speed), .place = {now.x, now.y}};
  if (count_ > 0) {
    const Sample& last = back(0);
    const model::VehicleParams& car = model_.vehicle();
    next.turned = last.turned + angle_difference(now.psi, last_psi_);
    next.angle = last.angle;
    next.swung = last.swung;
    next.braking = last.braking;
    const double part = (now.time - last.time) / kParts;
    const double kept = car.steer_lag > 0.0 ? exp(-part / car.steer_lag) : 0.0;
    const double coasting = longitudinal_acceleration(car, 0.0, next.speed);
    double gained = next.speed - last.speed;  // otherwise than by the pedals
    for (int i = 0; i < kParts; ++i) {
      const model::Command command = sent.at(last.time + (i + 0.5) * part);
      const double before = angle_;
      angle_ = command.steer + (angle_ - command.steer) * kept;
      next.angle += 0.5 * part * (before + angle_);
      next.swung += std::fabs(angle_ - before);
      next.pedal += command.throttle / kParts;
      const double pushed = longitudinal_acceleration(car, command.throttle, next.speed);
      next.braking += part * std::max(coasting - pushed, 0.0);
      gained -= part * pushed;
    }
    if (next.pedal >= 0.0) speed_noise_ += (0.5 * gained * gained - speed_noise_) * kParts * part / kLearned;
  }
  last_psi_ = now.psi;
  samples_[count_ % kSamples] = next;
  ++count_;
}

/// The sample at `time` or just before it.
std::size_t ActuatorWatch::samples_back_to(double time) const noexcept {
  const std::size_t have = std::min(count_, kSamples);
  std::size_t i = 0;
  while (i + 1 < have && back(i).time > time) ++i;
  return i;
}

/// Whether the car moves otherwise across its heading than a car that grips: its tyres, not its wheels, are
/// what differs.
bool ActuatorWatch::slides(const Sample& from, double sideslip) const noexcept {
  const Sample& now = back(0);
  const Vec2 way = now.place - from.place;
  const double heading = last_psi_ - 0.5 * (now.turned - from.turned);
  return std::fabs(angle_difference(atan2(way.y(), way.x()), heading) - sideslip) > kSlides;
}

/// Equation 12: the wheel angle that turns the car as it turned over the last `length` [s], and the one that
/// was asked for. False where the tyres, not the wheels, may be what differs.
bool ActuatorWatch::measure(Window& window, double length, double elapsed) const noexcept {
  const Sample& now = back(0);
  const Sample& from = back(samples_back_to(now.time - length));
  const Sample& middle = back(samples_back_to(0.5 * (now.time + from.time)));
  const double first = middle.time - from.time, second = now.time - middle.time;
  if (!(first > 0.0 && second > 0.0)) return false;
  const double time = first + second;
  const double change = (now.turned - middle.turned) / second - (middle.turned - from.turned) / first;
  window.asked = (now.angle - from.angle) / time;
  window.changed =
      std::max(std::fabs((now.angle - middle.angle) / second - (middle.angle - from.angle) / first),
               kLateCommand / time * (now.swung - from.swung));
  model::BodyMotion<double> car{.vx = 0.5 * (now.speed + from.speed),
                                .vy = window.slide,
                                .r = (now.turned - from.turned) / time,
                                .steer = window.asked,
                                .acceleration = (now.speed - from.speed) / time};
  window.angle = car.steer = model_.steer_for(car, 2.0 * change / time);
  window.slip = car.steer - (window.slide + model_.vehicle().front_axle * car.r) / car.vx;
  window.rear_slip = (model_.vehicle().rear_axle * car.r - window.slide) / car.vx;
  const auto tires = model_.tire_use(car);
  window.slide = model_.advance(car, car.steer, car.acceleration, elapsed).vy;
  const double sideslip = std::fabs(window.slide) / car.vx;
  if (sideslip > 2.0 * kMostSideslip) window.slide = 0.0;
  window.use = std::max(tires.front, tires.rear);
  const bool is_calm = window.use < kMostUse && use_.rear < kMostUse && sideslip < kMostSideslip &&
                       !slides(from, window.slide / car.vx);
  window.calm_for = is_calm ? window.calm_for + elapsed : 0.0;
  return window.calm_for > kCalmFor * pace_;
}

void ActuatorWatch::judge_steering(Window& window, double length, double elapsed) noexcept {
  if (!measure(window, length, elapsed)) {
    window.differs_for = 0.0;
    return;
  }
  const double before = window.difference;
  window.difference = window.angle - window.asked - answer_.offset;
  // The car may slide otherwise than these sums have it.
  const double unsure_slide = use_.sideslip ? std::fabs(window.slide / back(0).speed - *use_.sideslip) : 0.0;
  const double slip_share = window.use > kSpareUse ? kSlipShareUsed : kSlipShare;
  const double band = kBand + kBandShare * std::fabs(window.asked) +
                      slip_share * std::max(std::fabs(window.slip), std::fabs(window.rear_slip)) +
                      window.changed + unsure_slide + kDeviations * std::sqrt(window.noise);
  // Wheels that turn the car less than asked for may as well lack grip.
  const bool may_lack_grip = window.use > kSpareUse && window.difference * window.slip < 0.0;
  const bool differs =
      window.learned > kLeastLearned && !may_lack_grip && std::fabs(window.difference) > band;
  window.differs_for = differs ? window.differs_for + elapsed : 0.0;
  // Noise is what changes from one measurement to the next; another answer stays.
  const double change =
      std::min(std::fabs(window.difference - before), kBand + 3.0 * std::sqrt(window.noise));
  window.learned = std::min(window.learned + elapsed, kLearned);
  window.noise += (0.5 * change * change - window.noise) * elapsed / window.learned;
  if (window.differs_for > kDiffersFor * pace_ && (follows_ || !is_steered_)) {
    is_steered_ = follows_ = true;
    gg_ = go_ = oo_ = g_ = o_ = memory_ = 0.0;
    usual_for_ = 0.0;
    for (Window& each : windows_) each.differs_for = 0.0;
  }
  // Of a noisy sensor the long window tells more.
  const bool is_quiet = kDeviations * std::sqrt(windows_[0].noise) < kBand;
  if (is_steered_ && !may_lack_grip && is_quiet == (&window == &windows_[0]))
    fit_steering(window, length, elapsed);
}

/// Least squares with a memory, about the usual answer. Wheels whose angle does not follow the commands get
/// none of them, or get them late, or are stuck: no other command mends that.
void ActuatorWatch::fit_steering(const Window& window, double length, double elapsed) noexcept {
  const double asked = window.asked, difference = window.angle - asked;
  memory_ = std::min(memory_ + elapsed, kMemory);
  const double kept = 1.0 - elapsed / (memory_ + elapsed);
  const double variance = kAngleNoise * kAngleNoise + window.noise;
  const double weight = memory_ / (length * variance) * (1.0 - kept);
  gg_ = kept * gg_ + weight * asked * asked;
  go_ = kept * go_ + weight * asked;
  oo_ = kept * oo_ + weight;
  g_ = kept * g_ + weight * asked * difference;
  o_ = kept * o_ + weight * difference;
  const double a = gg_ + 1.0 / (kGainPrior * kGainPrior);
  const double b = oo_ + 1.0 / (kOffsetPrior * kOffsetPrior);
  const double determinant = a * b - go_ * go_;
  const double gain = (b * g_ - go_ * o_) / determinant, offset = (a * o_ - go_ * g_) / determinant;
  const bool begins_to_follow = !std::exchange(follows_, std::fabs(gain) < kUsualGain) && follows_;
  answer_.offset = follows_ ? std::clamp(offset, -kMostOffset, kMostOffset) : 0.0;
  const bool is_usual = follows_ && std::fabs(offset) < kUsualOffset;
  usual_for_ = is_usual ? usual_for_ + elapsed : 0.0;
  if (usual_for_ < kUsualFor && !begins_to_follow) return;
  is_steered_ = false;
  answer_.offset = 0.0;
}

/// Equation 13: how the car slowed down against what its brakes were asked for.
void ActuatorWatch::judge_braking(double elapsed) noexcept {
  const model::VehicleParams& car = model_.vehicle();
  const Sample& now = back(0);
  const std::size_t size = samples_back_to(now.time - kLong * pace_);
  const Sample& from = back(size);
  double gentlest = -1.0;
  for (std::size_t i = 0; i <= size; ++i) gentlest = std::max(gentlest, back(i).pedal);
  if (gentlest > -kBraked * car.brake_throttle_limit || std::max(use_.front, use_.rear) > kMostUse) {
    weak_for_ = 0.0;
    return;
  }
  const double coasting = longitudinal_acceleration(car, 0.0, 0.5 * (now.speed + from.speed));
  const double braked = (from.speed - now.speed) + coasting * (now.time - from.time);
  const double asked = now.braking - from.braking;
  const double share = std::clamp(braked / asked, kLeastShare, 1.0);
  weak_for_ = braked + 3.0 * std::sqrt(2.0 * speed_noise_) < kWeak * asked ? weak_for_ + elapsed : 0.0;
  if (weak_for_ == 0.0 || weak_for_ == elapsed) share_ = share;
  share_ += (share - share_) * std::min(elapsed / (kBrakingTime * pace_), 1.0);
  if (weak_for_ > kWeakFor * pace_ || has_weak_brakes()) answer_.braking = share_ > kStrong ? 1.0 : share_;
}

}  // namespace chicane::safety
