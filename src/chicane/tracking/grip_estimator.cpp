// SPDX-License-Identifier: MIT
#include "chicane/tracking/grip_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "chicane/model/vehicle.hpp"

namespace chicane::tracking {
namespace {

constexpr double kLongestSilence = 0.25;  // [s] between measurements; then the estimators settle first
constexpr double kPerfectSensor = 1e-8;   // [m²] variance of a perfect sensor
constexpr double kFarAside = 1.0;         // [m] a measurement that is another thing than noise

}  // namespace

void GripEstimator::begin(const StateEstimator& from, const model::PredictionModel& assumed) noexcept {
  const auto copy = [&](double share) {
    StateEstimator estimator = from;
    estimator.estimate_disturbance(false);
    estimator.set_model(model::PredictionModel{model::with_grip(assumed.vehicle(), share)});
    return estimator;
  };
  *this = GripEstimator{copy(1.0), copy(1.0 - kStep), copy(1.0)};
}

void GripEstimator::see(const model::Measurement& now, const CommandHistory& sent) noexcept {
  const double elapsed = now.time - assumed_.time();
  assumed_.correct(now, sent);
  less_.correct(now, sent);
  model::Measurement later = now;  // on a clock that is late all commands are
  later.time -= kLate;
  late_.correct(later, sent);
  const double n = assumed_.surprise().aside, less = less_.surprise().aside;
  const bool is_seen =
      elapsed > 0.0 && elapsed < kLongestSilence && std::fabs(n) < kFarAside && std::isfinite(less);
  const model::State& car = assumed_.state();
  const double by_tyres = (1.0 - assumed_.model().vehicle().steer_helper) * car.vx * car.r;
  const bool goes_on = std::fabs(by_tyres) > 0.5 * kLeast && by_tyres * side_ >= 0.0;
  if (bend_time_ >= (goes_on ? kLongestBend : kShortestBend)) end_bend();
  if (!is_seen || !(std::fabs(by_tyres) >= kLeast)) return;
  side_ = by_tyres;
  const double left = kMemory / (kMemory + elapsed);
  time_ = left * time_ + elapsed;
  interval_ = interval_ > 0.0 ? interval_ + 0.05 * (elapsed - interval_) : elapsed;
  const double h = (less - n) / kStep;
  all_.add(h, n, left, elapsed);
  bend_.add(h, n, 1.0, elapsed);
  bend_time_ += elapsed;
  const double off = assumed_.surprise().heading, late = late_.surprise().heading;
  if (!std::isfinite(late)) return;
  off_ = left * off_ + elapsed * off * off;
  by_time_ = left * by_time_ + elapsed * (late - off) * (late - off) / (kLate * kLate);
}

void GripEstimator::end_bend() noexcept {
  const double each = kMemory / (kMemory + bend_time_), left = each * each;  // squares fade twice as fast
  bends_ = {.hnhn = left * bends_.hnhn + bend_.hn * bend_.hn,
            .hnhh = left * bends_.hnhh + bend_.hn * bend_.hh,
            .hhhh = left * bends_.hhhh + bend_.hh * bend_.hh,
            .count = bends_.count + 1};
  bend_ = {};
  bend_time_ = 0.0;
}

void GripEstimator::Sums::add(double h, double n, double left, double elapsed) noexcept {
  hh = left * hh + elapsed * h * h;
  hn = left * hn + elapsed * h * n;
  nn = left * nn + elapsed * n * n;
}

double GripEstimator::Sums::variance(double time) const noexcept {
  const double explained = hh > 0.0 ? hn * hn / hh : 0.0;
  return std::max((nn - explained) / time, kPerfectSensor);
}

double GripEstimator::share() const noexcept {
  return is_known() ? std::clamp(1.0 + all_.hn / all_.hh, kLow, kHigh) : 1.0;
}

double GripEstimator::unsure_time() const noexcept {
  return by_time_ > 0.0 ? std::sqrt(off_ / by_time_) : std::numeric_limits<double>::infinity();
}

bool GripEstimator::differs(double least) const noexcept {
  return is_known() && std::fabs(share() - 1.0) > std::max(least, 2.0 * deviation());
}

double GripEstimator::deviation() const noexcept {
  if (!(all_.hh > 0.0) || bends_.count < 2) return std::numeric_limits<double>::infinity();
  const double by_noise = interval_ * all_.variance(time_) / all_.hh;
  const double d = all_.hn / all_.hh;
  const double scatter = std::max(bends_.hnhn - 2.0 * d * bends_.hnhh + d * d * bends_.hhhh, 0.0);
  const double n = std::min(static_cast<double>(bends_.count), kMemory / kShortestBend);
  const double by_bends = n / (n - 1.0) * scatter / (all_.hh * all_.hh);  // the share takes up one of n
  return std::sqrt(std::max(by_noise, by_bends));
}

}  // namespace chicane::tracking
