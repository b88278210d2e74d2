// SPDX-License-Identifier: MIT
#include "chicane/safety/actuator_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/model/prediction.hpp"

namespace chicane::safety {
namespace {

// Origins (chosen: by trial, see Guard):
// - Derived: kLongestSilence, kFarAside, kPerfectSensor (as of tracking::GripEstimator), kSure (99.7 % of a
//   normal distribution).
// - Measured: kMostApart (docs/identification.md: twice the usual).
// - Chosen, docs/identification.md: kMostUse, kCalmFor, kAverage, kAverageSliding.
// - Chosen, for what their lines say: kKeptBehind, kCorrelated, kShown, kMostDeviation; and coarse, half or
//   double passes each test of this module: kSlowest, kCounted, kFar, kMostCorrelation.
constexpr double kSlowest = 5.0;          // [m/s] slower, the wheels turn the car too little
constexpr double kLongestSilence = 0.25;  // [s] between measurements; then the estimators settle first
constexpr double kMostUse = 0.5;          // share of peak slip or peak force: beyond it no model is exact
constexpr double kCalmFor = 0.5;          // [s] after that, until the estimators have settled
constexpr double kFarAside = 1.0;         // [m] a measurement that is another thing than noise
constexpr double kPerfectSensor = 1e-8;   // of m and rad: that of a perfect sensor
constexpr double kAverage = 0.5;          // [s] over which the estimators forget what they did not expect
constexpr double kMostApart = 0.1;        // [m] twice the usual: further, the differences are no slopes
constexpr double kAverageSliding = 0.2;   // [s] the same beyond kMostUse, where a car may be unstable
constexpr double kCounted = 0.5;          // [s] that the estimators count from one place at least
constexpr double kKeptBehind = 0.5;       // share of the sums that is kept where the estimators move on
constexpr double kFar = 1.0;  // deviations of the estimate from that place, from which on it is another one
constexpr double kCorrelated = 2.0;        // [s] of which correlation and variance are the mean
constexpr double kMostCorrelation = 0.98;  // from one measurement to the next: some information is left
constexpr double kSure = 3.0;              // deviations by which an estimate differs from what is driven with
constexpr double kShown = 1.0;  // [s] of driving until the estimate is reported and an offset driven with
constexpr double kMostDeviation = 0.1;  // share of the usual deviation: a less certain estimate is not used

// Of delay [s], gain, offset [rad] and grip: by how much an estimator differs, what is assumed to be usual
// (standard deviation), the step in which the car is driven with, and the range. Chosen;
// docs/identification.md has the usual values.
struct Row {
  double change, usual, step, least, most;
};
constexpr std::array<Row, 4> kRows{{
    {0.02, 0.1, 0.008, -0.1, ActuatorEstimator::kMostDelay},
    {0.1, 0.3, 0.03, 0.35, 2.5},
    {0.01, 0.05, 0.003, -0.25, 0.25},
    {-0.1, 0.3, 0.05, 0.3, 1.6},
}};
constexpr std::array kUsual{0.0, 1.0, 0.0, 1.0};

/// Use of the tyres at the busier axle: slip over peak slip, or longitudinal force over peak force.
double tire_use(const tracking::StateEstimator& estimator) noexcept {
  const model::State& car = estimator.state();
  const auto use = estimator.model().tire_use(
      model::BodyMotion<double>{car.vx, car.vy, car.r, car.steer, estimator.acceleration()});
  return std::max({use.front, use.rear, std::fabs(use.along_front), std::fabs(use.along_rear)});
}

/// Estimators of the same car, as many as asked for.
template <std::size_t Count>
std::array<tracking::StateEstimator, Count> estimators_of(const model::VehicleParams& vehicle) noexcept {
  const auto make = [&](auto) { return tracking::StateEstimator{model::PredictionModel{vehicle}}; };
  return std::apply([&](auto... each) { return std::array{make(each)...}; }, std::array<int, Count>{});
}

}  // namespace

ActuatorEstimator::ActuatorEstimator(const model::VehicleParams& vehicle) noexcept
    : vehicle_{without_name(vehicle)}, estimators_{estimators_of<kUnknowns + 1>(vehicle_)} {
  for (tracking::StateEstimator& each : estimators_) each.average_over(kAverage);
  configure_estimators();
}

void ActuatorEstimator::reset() noexcept { *this = ActuatorEstimator{vehicle_}; }

void ActuatorEstimator::set_vehicle(const model::VehicleParams& vehicle) noexcept {
  vehicle_ = without_name(vehicle);
  configure_estimators();
}

/// The estimators' models, by the grip that they count with.
void ActuatorEstimator::configure_estimators() noexcept {
  for (std::size_t i = 0; i <= kUnknowns; ++i) {
    const double grip = here_[kGrip] + (i == kGrip ? kRows[kGrip].change : 0.0);
    estimators_[i].set_model(model::PredictionModel{model::with_grip(vehicle_, grip)});
  }
}

/// How the wheels turn by `commanded`, if they answered as `values` say.
tracking::CommandHistory ActuatorEstimator::effect(const tracking::CommandHistory& commanded,
                                                   const Values& values) const noexcept {
  const ActuatorAnswer answer{.gain = values[kGain], .offset = values[kOffset]};
  tracking::CommandHistory sent =
      commanded.changed([&](const model::Command& command) { return answer.effect_of(command); });
  sent.delay(values[kDelay] - answer_.delay);
  return sent;
}

void ActuatorEstimator::see(const model::Measurement& now,
                            const tracking::CommandHistory& commanded) noexcept {
  tracking::StateEstimator& last = estimators_[kUnknowns];
  const double elapsed = now.time - last.time();
  last.correct(now, effect(commanded, here_));
  const tracking::StateEstimator::Surprise n = last.surprise();
  Values aside{}, heading{};
  double sum = n.aside + n.heading, apart = 0.0;
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    const double by = kRows[i].change;
    Values changed = here_;
    changed[i] += by;
    estimators_[i].correct(now, effect(commanded, changed));
    const tracking::StateEstimator::Surprise& other = estimators_[i].surprise();
    aside[i] = (n.aside - other.aside) / by;
    heading[i] = (n.heading - other.heading) / by;
    sum += other.aside + other.heading;
    apart = std::max(apart, std::fabs(n.aside - other.aside));
  }
  const bool is_seen =
      elapsed > 0.0 && elapsed < kLongestSilence && std::isfinite(sum) && std::fabs(n.aside) < kFarAside;
  const bool slides = tire_use(last) > kMostUse || apart > kMostApart;
  for (tracking::StateEstimator& each : estimators_) {
    each.average_over(slides ? kAverageSliding : kAverage);
    if (slides) each.set_state(last.state());
  }
  if (slides) slid_at_ = now.time;
  if (!is_seen || !(last.state().vx > kSlowest)) return;
  if (std::fabs(now.time - slid_at_) < kCalmFor) return;
  const double kept = kMemory / (kMemory + elapsed);
  const double share = std::min(elapsed / kCorrelated, 1.0);
  time_ = kept * time_ + elapsed;
  interval_ = interval_ > 0.0 ? interval_ + 0.05 * (elapsed - interval_) : elapsed;
  double aside_left = n.aside, heading_left = n.heading;
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    aside_left -= aside[i] * solution_.value[i];
    heading_left -= heading[i] * solution_.value[i];
  }
  aside_.add(aside, n.aside, aside_left, kept, elapsed, share);
  heading_.add(heading, n.heading, heading_left, kept, elapsed, share);
  solution_ = solve();
  counted_ += elapsed;
  if (counted_ > kCounted) move_on();
}

/// The estimators count from the estimate on where that is further away than their differences reach. What
/// was summed up from further away counts half.
void ActuatorEstimator::move_on() noexcept {
  bool is_far = false;
  for (std::size_t i = 0; i < kUnknowns; ++i)
    is_far = is_far || std::fabs(solution_.value[i]) >
                           std::max(0.5 * std::fabs(kRows[i].change), kFar * solution_.deviation[i]);
  if (!is_far) return;
  Values by;
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    const double next = std::clamp(here_[i] + solution_.value[i], kRows[i].least, kRows[i].most);
    by[i] = next - std::exchange(here_[i], next);
  }
  for (tracking::StateEstimator& each : estimators_) each.set_state(estimators_[kUnknowns].state());
  slid_at_ = estimators_[kUnknowns].time();
  aside_.shift(by, kKeptBehind);
  heading_.shift(by, kKeptBehind);
  counted_ = 0.0;
  configure_estimators();
  solution_ = solve();
}

void ActuatorEstimator::Sums::add(const Values& h, double n, double unexplained, double kept, double elapsed,
                                  double share) noexcept {
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    hn[i] = kept * hn[i] + elapsed * h[i] * n;
    for (std::size_t j = 0; j < kUnknowns; ++j) hh[i][j] = kept * hh[i][j] + elapsed * h[i] * h[j];
  }
  left += share * (unexplained * unexplained - left);
  product += share * (unexplained * last - product);
  last = unexplained;
}

void ActuatorEstimator::Sums::shift(const Values& by, double kept) noexcept {
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    for (std::size_t j = 0; j < kUnknowns; ++j) hn[i] -= hh[i][j] * by[j];
    hn[i] *= kept;
    for (double& each : hh[i]) each *= kept;
  }
}

double ActuatorEstimator::Sums::weight() const noexcept {
  const double variance = std::max(left, kPerfectSensor);
  const double correlation = std::clamp(product / variance, 0.0, kMostCorrelation);
  return (1.0 - correlation) / ((1.0 + correlation) * variance);
}

/// Least squares about what is usual; the inverse of the normal matrix is the covariance.
ActuatorEstimator::Solution ActuatorEstimator::solve() const noexcept {
  const double aside = aside_.weight() / interval_, heading = heading_.weight() / interval_;
  // [A | b | 1], in units of what is usual; becomes [1 | x | inverse].
  std::array<std::array<double, 2 * kUnknowns + 1>, kUnknowns> rows{};
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    const double unit = kRows[i].usual;
    for (std::size_t j = 0; j < kUnknowns; ++j)
      rows[i][j] = unit * kRows[j].usual * (aside * aside_.hh[i][j] + heading * heading_.hh[i][j]);
    rows[i][kUnknowns] =
        unit * (aside * aside_.hn[i] + heading * heading_.hn[i]) + (kUsual[i] - here_[i]) / unit;
    rows[i][i] += 1.0;
    rows[i][kUnknowns + 1 + i] = 1.0;
  }
  for (std::size_t k = 0; k < kUnknowns; ++k) {  // positive definite: no pivoting
    const double pivot = 1.0 / rows[k][k];
    for (double& each : rows[k]) each *= pivot;
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      if (i == k) continue;
      const double factor = rows[i][k];
      for (std::size_t j = 0; j < rows[i].size(); ++j) rows[i][j] -= factor * rows[k][j];
    }
  }
  Solution found;
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    found.value[i] = kRows[i].usual * rows[i][kUnknowns];
    found.deviation[i] = kRows[i].usual * std::sqrt(std::max(rows[i][kUnknowns + 1 + i], 0.0));
  }
  return found;
}

bool ActuatorEstimator::is_certain(Unknown i) const noexcept {
  return time_ >= (i == kOffset ? kShown : kEnough) &&
         solution_.deviation[i] <= kMostDeviation * kRows[i].usual;
}

/// Delay and gain pass for each other, and for what the model lacks, in bends that are much alike: both are
/// known, or neither is. The offset shows on straights as well.
bool ActuatorEstimator::take_up() noexcept {
  if (!is_certain(kOffset)) return false;
  const ActuatorAnswer before = answer_;
  const auto follow = [&](double& driven, Unknown i) {
    const double estimate = std::clamp(here_[i] + solution_.value[i], kRows[i].least, kRows[i].most);
    const double deviation = solution_.deviation[i];
    const bool is_better = deviation < 0.5 * taken_up_[i];
    const double apart = kSure * (is_better ? deviation : hypot(deviation, taken_up_[i]));
    if (std::fabs(estimate - driven) <= std::max(kRows[i].step, apart)) return;
    driven = estimate;
    taken_up_[i] = deviation;
  };
  if (is_certain(kDelay) && is_certain(kGain)) {
    follow(answer_.delay, kDelay);
    follow(answer_.gain, kGain);
  }
  follow(answer_.offset, kOffset);
  return answer_.delay != before.delay || answer_.gain != before.gain || answer_.offset != before.offset;
}

controller::LearnedCar ActuatorEstimator::learned() const noexcept {
  if (time_ < kShown) return {};
  const auto estimate = [&](Unknown i) {
    return controller::Estimate{here_[i] + solution_.value[i], solution_.deviation[i]};
  };
  return {.delay = estimate(kDelay),
          .gain = estimate(kGain),
          .offset = estimate(kOffset),
          .grip = estimate(kGrip)};
}

}  // namespace chicane::safety
