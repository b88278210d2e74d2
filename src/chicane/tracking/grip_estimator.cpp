// SPDX-License-Identifier: MIT
#include "chicane/tracking/grip_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "chicane/model/grip.hpp"

namespace chicane::tracking {
namespace {

constexpr double kLongestSilence = 0.25;  // [s] between measurements; then the estimators settle first
constexpr double kPerfectSensor = 1e-8;   // of m and rad: that of a perfect sensor
constexpr double kFarAside = 1.0;         // [m] a measurement that is another thing than noise

}  // namespace

void GripEstimator::begin(const StateEstimator& from, const model::PredictionModel& believed) noexcept {
  const auto copy = [&](double share) {
    StateEstimator estimator = from;
    estimator.estimate_disturbance(false);
    estimator.set_model(model::PredictionModel{model::with_grip(believed.vehicle(), share)});
    return estimator;
  };
  believed_ = copy(1.0);
  less_ = copy(1.0 - kStep);
  time_ = interval_ = 0.0;
  aside_ = heading_ = {};
}

void GripEstimator::see(const model::Measurement& now, const CommandHistory& sent) noexcept {
  const double elapsed = now.time - believed_.time();
  believed_.correct(now, sent);
  less_.correct(now, sent);
  const StateEstimator::Surprise& n = believed_.surprise();
  const StateEstimator::Surprise& less = less_.surprise();
  const bool is_seen = elapsed > 0.0 && elapsed < kLongestSilence && std::fabs(n.aside) < kFarAside &&
                       std::isfinite(n.heading + less.aside + less.heading);
  const model::State& car = believed_.state();
  const double by_tyres = (1.0 - believed_.model().vehicle().steer_helper) * car.vx * car.r;
  if (!is_seen || !(std::fabs(by_tyres) >= kLeast)) return;
  const double left = kMemory / (kMemory + elapsed);
  time_ = left * time_ + elapsed;
  interval_ = interval_ > 0.0 ? interval_ + 0.05 * (elapsed - interval_) : elapsed;
  aside_.add((less.aside - n.aside) / kStep, n.aside, left, elapsed);
  heading_.add((less.heading - n.heading) / kStep, n.heading, left, elapsed);
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
  if (!is_known()) return 1.0;
  const double aside = 1.0 / aside_.variance(time_), heading = 1.0 / heading_.variance(time_);
  const double share =
      1.0 + (aside * aside_.hn + heading * heading_.hn) / (aside * aside_.hh + heading * heading_.hh);
  return std::clamp(share, kLow, kHigh);
}

bool GripEstimator::differs(double least) const noexcept {
  return is_known() && std::fabs(share() - 1.0) > std::max(least, 2.0 * deviation());
}

double GripEstimator::deviation() const noexcept {
  if (!(time_ > 0.0)) return std::numeric_limits<double>::infinity();
  const double information =
      (aside_.hh / aside_.variance(time_) + heading_.hh / heading_.variance(time_)) / interval_;
  return information > 0.0 ? 1.0 / std::sqrt(information) : std::numeric_limits<double>::infinity();
}

}  // namespace chicane::tracking
