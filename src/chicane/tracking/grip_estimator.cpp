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
  aside_ = heading_ = bend_aside_ = bend_heading_ = {};
  bend_time_ = 0.0;
  bends_ = {};
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
  const double by_place = (less.aside - n.aside) / kStep, by_heading = (less.heading - n.heading) / kStep;
  aside_.add(by_place, n.aside, left, elapsed);
  heading_.add(by_heading, n.heading, left, elapsed);
  bend_aside_.add(by_place, n.aside, 1.0, elapsed);
  bend_heading_.add(by_heading, n.heading, 1.0, elapsed);
  bend_time_ += elapsed;
  if (bend_time_ >= kBend) end_bend();
}

GripEstimator::Evidence GripEstimator::weigh(const Sums& aside, const Sums& heading) const noexcept {
  const double by_place = 1.0 / aside_.variance(time_), by_heading = 1.0 / heading_.variance(time_);
  return {.hn = by_place * aside.hn + by_heading * heading.hn,
          .hh = by_place * aside.hh + by_heading * heading.hh};
}

void GripEstimator::end_bend() noexcept {
  const Evidence bend = weigh(bend_aside_, bend_heading_);
  const double each = kMemory / (kMemory + bend_time_), left = each * each;  // of squares of what (3) sums
  bends_ = {.gg = left * bends_.gg + bend.hn * bend.hn,
            .gh = left * bends_.gh + bend.hn * bend.hh,
            .hh = left * bends_.hh + bend.hh * bend.hh,
            .count = bends_.count + 1};
  bend_aside_ = bend_heading_ = {};
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
  if (!is_known()) return 1.0;
  const Evidence all = weigh(aside_, heading_);
  return std::clamp(1.0 + all.hn / all.hh, kLow, kHigh);
}

bool GripEstimator::differs(double least) const noexcept {
  return is_known() && std::fabs(share() - 1.0) > std::max(least, 2.0 * deviation());
}

double GripEstimator::deviation() const noexcept {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  if (!(time_ > 0.0)) return kInfinite;
  const Evidence all = weigh(aside_, heading_);
  if (!(all.hh > 0.0)) return kInfinite;
  const double by_noise = interval_ / all.hh;
  // Of n bends, the share itself takes up one.
  const double d = all.hn / all.hh;
  const double scatter = std::max(bends_.gg - 2.0 * d * bends_.gh + d * d * bends_.hh, 0.0);
  const double count = std::min(static_cast<double>(bends_.count), kMemory / kBend);
  const double by_bends = count > 1.0 ? count / (count - 1.0) * scatter / (all.hh * all.hh) : kInfinite;
  return std::sqrt(std::max(by_noise, by_bends) + between_signals());
}

double GripEstimator::between_signals() const noexcept {
  if (!(aside_.hh > 0.0) || !(heading_.hh > 0.0)) return 0.0;
  const double by_place = aside_.hh / aside_.variance(time_),
               by_heading = heading_.hh / heading_.variance(time_);
  const double apart = aside_.hn / aside_.hh - heading_.hn / heading_.hh;
  const double both = by_place + by_heading;
  return by_place * by_heading / (both * both) * apart * apart;
}

}  // namespace chicane::tracking
