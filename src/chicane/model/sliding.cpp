// SPDX-License-Identifier: MIT
#include "chicane/model/sliding.hpp"

#include <cmath>

#include "chicane/base/math.hpp"
#include "chicane/model/yaw_stability.hpp"

namespace chicane::model {
namespace {

constexpr double kHalfPi = 1.5707963267948966;
constexpr double kStep = 0.01;  // between slips that are tried
constexpr int kFrontSlips = 9;

}  // namespace

SlidingBound::SlidingBound(const VehicleParams& car, double delay) noexcept : car_{car} {
  if (car.friction_coupling > 0.0) return;
  while (front_ > kStep && slope(front_) < kFrontSlope) front_ -= kStep;
  const double most_pole = log(kMostGrowth) / delay;
  permits_ = true;
  for (std::size_t i = 0; i < rear_.size(); ++i) {
    const double v = kLeastSpeed + kSpeedStep * static_cast<double>(i);
    double& slip = rear_[i];
    for (slip = 1.0; slip + kStep < kMostSlip + 0.5 * kStep; slip += kStep)
      if (worst_pole(v, slip + kStep) > most_pole) break;
    permits_ = permits_ && worst_pole(v, slip) <= most_pole;
  }
}

double SlidingBound::longest_delay(const VehicleParams& car) noexcept {
  const SlidingBound bound(car);
  if (car.friction_coupling > 0.0) return 0.0;
  double pole = 0.0;
  for (int i = 0; i < kSpeeds; ++i)
    pole = std::max(pole, bound.worst_pole(kLeastSpeed + kSpeedStep * i, 1.0));
  return log(kMostGrowth) / pole;
}

double SlidingBound::slope(double slip) const noexcept {
  const double c = car_.tire_shape;
  if (c > 0.0) {
    const double z = slip * tan(kHalfPi / c);
    return cos(c * atan(z)) / (1.0 + z * z);
  }
  if (slip < 1.0) return 1.0 + 2.0 * slip - 3.0 * slip * slip;
  const double w = std::min((slip - 1.0) / 1.5, 1.0);
  return -w * (1.0 - w);
}

double SlidingBound::pole(double v, double front_slip, double rear_slip) const noexcept {
  const double load = car_.load(v);
  const double front = car_.cornering_front * load * car_.rear_axle / car_.wheelbase() * slope(front_slip);
  const double rear = car_.cornering_rear * load * car_.front_axle / car_.wheelbase() * slope(rear_slip);
  return yaw_pole(car_, v, {front, rear});
}

double SlidingBound::worst_pole(double v, double rear_slip) const noexcept {
  double worst = pole(v, 0.0, rear_slip);
  for (int i = 1; i <= kFrontSlips; ++i)
    worst = std::max(worst, pole(v, front_ * i / kFrontSlips, rear_slip));
  return worst;
}

}  // namespace chicane::model
