// SPDX-License-Identifier: MIT
// Clock of an external car: decides from displacement and speed whether its time is the wall's, a multiple of
// it, or one step for each answer.
#include "chicane/run/plant_clock.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "chicane/base/duration.hpp"
#include "chicane/base/math.hpp"
#include "chicane/base/median.hpp"

namespace chicane::run {
namespace {

// Values hold for a car in full size. For a smaller one kLegWay and kJump are reduced with its length, and
// kLeastSpeed, kLeastAsked and kSampledSpeed with the root of its length. The others stay.
//
// Origins, also of the constants in the header (chosen: by trial, see Guard). "Test" is plant_clock_test.
// Derived:
// - kFullSize: mean length of the full-size cars in data/cars (4.57 m).
// - kLongestCycle: StateEstimator::kLongestGap, and the largest --lock-step-ms.
// - kSampling: physics step of the original (docs/model.md, table 1).
// - kLegSamples: one physics step more or less is a fifth of a leg, well within kOtherClock. The leg of 0.1 s
//   is shorter than a cycle of the original.
// - kOtherClock: above that fifth (|log 0.8| = 0.22), below a clock of half the speed (|log 0.5| = 0.69).
// - kFaster: in real time, a message that is late by a whole cycle makes the next leg twice as fast.
// Measured, by simulated exchanges:
// - kLeastDeviation: a lock step of 20 ms is found with 3 ms, and not with 4 ms.
// - kSteadier: at ratio 0.2 with a jitter of 30 % and physics of 20 ms, 2 of 16 runs of 20 s change to lock
// step
//   and back. With 0.5 it is 5 runs, with 0.7 8 runs.
// - kLegs: with kSteadier 0.5 and 10 legs 12 of the same runs do. With 14 it is 4 runs, but the test's
// changing
//   clock is found too late.
// Chosen, docs/protocol.md ("Time"):
// - kSlowest, kFastest: the range that is documented. kLongestStep: the test's pause of 3 s is no jump.
// - kLeastChange: below the test's ratios of 0.8 and 1.25.
// - kPedalError: below 1.61² = 2.6 of a speed in km/h for mph. Its root, 1.22, bounds the doubtful ratios.
// Chosen, with a bound from the test:
// - kLegWay, kLeastSpeed, kLeastAsked: one step of 0.6 s from rest has 0.98 m, 1.6 m/s and 3.2 m/s.
// - kLeastLegs: 2 to 8. At ratio 5 a car drives 0.6 s with each answer, so that few answers have to do.
// - kLate: with 0.3 s the changing clock is found too late.
// - kBurst: above the jitter of 0.3, below 0.76 of the step that had to wait.
// - kSpeedJump, kMostBraking: a speed that halves from 20 m/s in 0.12 s exceeds both together (5.2 m/s). A
//   grip of 28 m/s², as indy has, does not within 0.25 s.
// - kSame: below log 1.25 = 0.22. kLeastCounted: below 1.
// Chosen, without a bound (a tenth and four times each pass the test):
// - kLateInFew: 0.6 s in all, less than the 0.96 s by which two answers at ratio 5 exceed the wall's time.
// - kErrors: 2.7 standard errors of a sum of kLegs legs with late messages, 1.1 of one of independent errors.
// - kDrives: as in guard_way_back.cpp. kPedalMemory: at pedal kDrives udacity gains 1.6 m/s in it, more than
//   kLeastAsked.
// - kSampledSpeed: 8 cm in kSampling, more than the 7 cm of a displacement with noise of 0.05 m.
// - kJump: four deviations of such a displacement. kClockAcross: a slip of 17°.
// - kOfStep: as kLeastChange. kFollowed: about 1 / kLegs. kSampledLeft: a memory of 20 answers.
// - kRest: well below kLeastSpeed.
constexpr double kFullSize = 4.5;      // [m] length of a full-size car
constexpr double kLegWay = 0.5;        // [m] least way of a leg
constexpr double kLeastSpeed = 0.5;    // [m/s] least speed that shows a time
constexpr double kLongestCycle = 1.0;  // [s] longest time between answers; a longer one is a silence
constexpr double kLongestStep = 5.0;   // [s] longest time between two measurements that are compared
constexpr std::size_t kLeastLegs = 2;  // legs needed to judge a clock
constexpr double kRest = 0.1;          // [m/s] a slower car stands
constexpr double kFaster = 2.0;        // ratio to the wall's time that the first leg from rest shows at once
constexpr double kLate = 0.15;         // [s] change of the sum of all legs by one late message
constexpr double kClockAcross = 0.3;   // most way across the heading, share of the way along it
constexpr double kJump = 0.3;          // [m] way across the heading that is allowed in any case
constexpr double kSpeedJump = 2.0;     // [m/s] change of the speed that is allowed in any case
constexpr double kMostBraking = 20.0;  // [m/s²] change of the speed that is allowed beyond kSpeedJump
constexpr double kDrives = 0.1;        // least pedal that drives
constexpr double kPedalMemory = 3.0;   // [s] time constant of the sums of speed gained by the pedal
constexpr double kLeastAsked = 1.0;    // [m/s] speed by the pedal that tells another clock from a wrong speed
constexpr double kSteadier = 0.25;  // a clock fits better if its deviation is below this share of the other's
constexpr double kLeastDeviation = 0.002;  // [s] deviation of the running sums below which both clocks fit
constexpr double kLateInFew = 4.0;         // factor of kLate while there are only kLeastLegs legs
constexpr double kErrors = 4.0;            // deviations of the running sums from which a ratio is another one
constexpr double kFollowed = 0.1;          // share of a difference by which the ratio follows each leg
constexpr double kBurst = 0.5;    // share of the expected time by which a delayed lock step differs from it
constexpr double kOfStep = 0.15;  // share by which that step, by its displacement, may differ from the others
constexpr double kSampling = 0.02;  // [s] change of a state's age from answer to answer: a usual physics step
constexpr double kLegSamples = 5.0;    // least length of a leg, in kSampling
constexpr double kSampledSpeed = 4.0;  // [m/s] least speed at which a displacement shows the state's age
constexpr double kLeastCounted = 0.1;  // least counted time of an answer, share of the expected one
constexpr double kSampledLeft = 0.95;  // decay of the time counted for the age of states, for each answer
constexpr double kOtherClock = 0.5;    // logarithm of a leg's ratio to the median, above which it is left out
constexpr double kSame = 0.03;         // logarithm of a ratio that counts as 1

}  // namespace

PlantClock::PlantClock(const PlantClockOptions& options, const model::VehicleParams& vehicle,
                       Clock::time_point start)
    : options_{options},
      vehicle_{vehicle},
      size_{std::min(vehicle.length / kFullSize, 1.0)},
      wall_{start},
      step_{options.lock_step} {}

void PlantClock::begin() {
  ratio_ = 1.0;
  step_ = options_.lock_step;
  has_last_ = false;
  forget();
}

/// Drops the legs: after a change of the speed sensor they predict nothing.
void PlantClock::forget() {
  is_speed_known_ = false;
  count_ = 0;
  leg_ = {};
  asked_ = gained_ = sampled_ = 0.0;
}

double PlantClock::at(Clock::time_point wall) const {
  const double since = ratio_ * seconds(wall - wall_);
  return time_ + (step_ > 0.0 ? std::clamp(since, 0.0, step_) : since);
}

bool PlantClock::advance(Clock::time_point received, const model::Measurement* measured,
                         const model::Command& acting) {
  const double wall = seconds(received - wall_);
  const bool is_first = !has_last_;
  wall_ = received;
  if (options_.is_measured) return follow(measured);
  Leg step;
  const bool is_whole = measured != nullptr && measured->is_finite();
  if (is_whole && has_last_ && options_.is_estimated && wall > 0.0 && wall < kLongestStep)
    step = step_of(wall, *measured, acting);
  time_ += time_of(wall, step);
  has_last_ = is_whole;
  if (is_whole) last_ = *measured;
  const bool is_new = step.steps > 0 && add(step) && take_up();
  if (leg_.steps == 0) gap_ = is_first ? 0.0 : wall;
  return is_new;
}

/// Measures each answer by the simulator's own time. True: the time jumped.
bool PlantClock::follow(const model::Measurement* measured) {
  if (measured == nullptr) {
    time_ += step_;
    ++unusable_;
    return false;
  }
  const double gap = has_last_ ? measured->time - last_.time : 0.0;
  const double step = gap / (1.0 + unusable_);
  const bool is_jump = gap < 0.0 || step > kLongestStep;
  if (!has_last_ || is_jump) ahead_ = time_ + step_ - measured->time;
  if (step > 0.0 && step < kLongestCycle) step_ += (step_ > 0.0 ? kFollowed : 1.0) * (step - step_);
  time_ = std::max(time_, ahead_ + measured->time);
  last_ = *measured;
  has_last_ = true;
  unusable_ = 0;
  return is_jump;
}

/// Run time of one answer: the lock step, or the time by the ratio, corrected by the displacement. The
/// displacement shows a delayed answer of a simulator that advances by equal steps, and the varying age of
/// the states that a simulator sends.
double PlantClock::time_of(double wall, const Leg& step) {
  if (step_ > 0.0) return step_;
  const double expected = ratio_ * wall;
  if (step.steps == 0 || std::fabs(last_.speed) < kSampledSpeed * std::sqrt(size_) || count_ < kLeastLegs)
    return expected;
  const double usual = fit([](const Leg& leg) { return leg.steps; }).value;
  if (std::fabs(step.plant - expected) > kBurst * expected && std::fabs(step.plant - usual) < kOfStep * usual)
    return step.plant;
  const double most = expected - sampled_ + kSampling;
  const double counted =
      std::clamp(step.plant, std::max(most - 2.0 * kSampling, kLeastCounted * expected), most);
  sampled_ = kSampledLeft * (sampled_ + counted - expected);
  return counted;
}

/// Leg of one step: the time that the simulator has advanced by since the last measurement. Without steps if
/// the displacement does not show it.
PlantClock::Leg PlantClock::step_of(double wall, const model::Measurement& now,
                                    const model::Command& acting) {
  const double speed = 0.5 * (std::fabs(now.speed) + std::fabs(last_.speed));
  const double heading = last_.psi + 0.5 * angle_difference(now.psi, last_.psi);
  const double dx = now.x - last_.x, dy = now.y - last_.y;
  const double way = dx * cos(heading) + dy * sin(heading);
  const double across = std::fabs(dy * cos(heading) - dx * sin(heading));
  const double gained = std::fabs(now.speed) - std::fabs(last_.speed);
  const double plant = way / std::max(speed, 1e-6);
  const double longest = std::min(std::max(plant, ratio_ * wall), 1.0);
  if (std::fabs(gained) > kSpeedJump + kMostBraking * longest) forget();
  // A way of 0 is accepted: the simulator may have made no step of its own, and the next way is longer.
  const bool is_driving = speed > kLeastSpeed * std::sqrt(size_) && way >= 0.0;
  const bool is_along = across < kJump * size_ + kClockAcross * way;
  if (!is_driving || !is_along || plant > kFastest * wall) {
    leg_ = {};
    return {};
  }
  if (acting.throttle > kDrives) {
    const double kept = exp(-plant / kPedalMemory);
    asked_ = kept * asked_ + plant * longitudinal_acceleration(vehicle_, acting.throttle, speed);
    gained_ = kept * gained_ + gained;
  }
  return {
      .wall = wall, .plant = plant, .way = way, .steps = 1, .is_from_rest = std::fabs(last_.speed) < kRest};
}

/// Adds a step to the running leg. True: the leg is complete, and there are enough to judge the clock.
bool PlantClock::add(const Leg& step) {
  leg_ = {leg_.wall + step.wall, leg_.plant + step.plant, leg_.way + step.way, leg_.steps + 1,
          leg_.steps == 0 ? step.is_from_rest : leg_.is_from_rest};
  // Longer legs, because fit() leaves out short ones that differ by one of the simulator's own steps.
  if (leg_.way < kLegWay * size_ || leg_.plant < kLegSamples * kSampling) return false;
  // A message that came late, while the car stood, shortens the wall's time to the next one.
  const bool seems_faster = leg_.is_from_rest && leg_.plant > kFaster * leg_.wall;
  const bool is_faster = seems_faster && leg_.plant > kFaster * gap_;
  if (leg_.plant > kSlowest * leg_.wall && seems_faster == is_faster) legs_[count_++ % kLegs] = leg_;
  leg_ = {};
  return count_ >= kLeastLegs || (count_ == 1 && is_faster);
}

/// Sums of the legs near the median, and the deviation of the running sums from their ratio. For the right
/// clock this deviation stays as small as the noise of a place and one step of the simulator; for a wrong one
/// it grows with each leg.
template <class Base>
PlantClock::Fit PlantClock::fit(const Base& base) const {
  const std::size_t size = std::min(count_, kLegs);
  const auto leg = [&](std::size_t i) -> const Leg& { return legs_[(count_ - size + i) % kLegs]; };
  const auto value_of = [&](std::size_t i) { return log(leg(i).plant / base(leg(i))); };
  std::array<double, kLegs> values{};
  for (std::size_t i = 0; i < size; ++i) values[i] = value_of(i);
  const double usual = median(std::span(values).first(size));
  Fit fit;
  double counted = 0.0, sum = 0.0, mean = 0.0, square = 0.0;
  const auto is_near = [&](std::size_t i) { return std::fabs(value_of(i) - usual) < kOtherClock; };
  for (std::size_t i = 0; i < size; ++i) {
    fit.all += leg(i).plant;
    fit.all_counted += base(leg(i));
    fit.near += is_near(i) ? leg(i).plant : 0.0;
    counted += is_near(i) ? base(leg(i)) : 0.0;
  }
  fit.value = fit.near / counted;
  for (std::size_t i = 0; i < size; ++i) {
    sum += is_near(i) ? leg(i).plant - fit.value * base(leg(i)) : 0.0;
    mean += sum / static_cast<double>(size);
    square += sum * sum / static_cast<double>(size);
  }
  fit.deviation = std::sqrt(std::max(square - mean * mean, 0.0));
  return fit;
}

bool PlantClock::take_up() {
  if (options_.lock_step > 0.0) return false;
  const Fit by_clock = fit([](const Leg& leg) { return leg.wall; });
  const Fit by_step = fit([](const Leg& leg) { return leg.steps; });
  const bool was_in_step = step_ > 0.0;
  const bool is_distinct = std::max(by_clock.deviation, by_step.deviation) > kLeastDeviation;
  // Sums of all legs change by the last delay alone, because a late message shortens the next leg.
  const double late = (count_ == kLeastLegs ? kLateInFew : 1.0) * kLate * std::max(ratio_, 1.0);
  const bool differs = std::fabs(by_clock.all - ratio_ * by_clock.all_counted) > late &&
                       std::fabs(log(by_clock.all / (ratio_ * by_clock.all_counted))) > log(kLeastChange);
  // In real time a busy machine makes the wall's clock look worse than equal steps, so lock step is not taken
  // up.
  const bool is_real_time = ratio_ == 1.0 && !differs;
  const bool is_in_step = was_in_step ? !(is_distinct && by_clock.deviation < kSteadier * by_step.deviation)
                                      : is_distinct && !is_real_time && count_ >= kLegs / 2 &&
                                            by_step.near == by_step.all &&
                                            by_step.deviation < kSteadier * by_clock.deviation;
  const Fit& found = is_in_step ? by_step : by_clock;
  double& counted = was_in_step ? step_ : ratio_;
  const double off = log(found.value / counted);
  const bool is_another = is_in_step != was_in_step ||
                          (std::fabs(off) > log(kLeastChange) + kErrors * found.deviation / found.near &&
                           (was_in_step || differs));
  if (!is_another) {
    if (count_ >= kLegs) is_speed_known_ = true;
    // Follows closely, unless the wall's time is counted.
    if (was_in_step || ratio_ != 1.0)
      counted *= exp(std::max(kFollowed, 1.0 / static_cast<double>(count_)) * off);
    return false;
  }
  // With a speed in another unit, the pedal's effect differs by the square of the unit's factor.
  const bool shows_speed = asked_ > kLeastAsked * std::sqrt(size_) && gained_ > 0.0;
  is_speed_known_ |= shows_speed && std::fabs(log(gained_ / asked_)) < log(kPedalError);
  if (!is_speed_known_) return false;
  step_ = is_in_step ? by_step.value : 0.0;
  ratio_ = std::fabs(log(by_clock.value)) < kSame ? 1.0 : by_clock.value;
  count_ = 0;
  return true;
}

std::string PlantClock::news() const {
  if (options_.is_measured) return "the simulator's time jumped: the run begins again";
  const std::string counted = step_ > 0.0
                                  ? fmt::format("the simulator advances {:.3g} s with each answer", step_)
                                  : fmt::format("the simulator's clock runs at {:.2f} of the wall's", ratio_);
  const bool is_doubtful = step_ == 0.0 && ratio_ != 1.0 && 2.0 * std::fabs(log(ratio_)) < log(kPedalError);
  return counted + ": counted by it" +
         (is_doubtful ? "; a speed that is wrong by that share looks the same" : "");
}

}  // namespace chicane::run
