// SPDX-License-Identifier: MIT
#include "chicane/model/braking_stability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "chicane/base/math.hpp"
#include "chicane/model/yaw_stability.hpp"

namespace chicane::model {
namespace {

constexpr double kGravity = 9.81;    // [m/s²]
constexpr int kHalvings = 8;         // of the range of forces, for the table
constexpr double kMostUse = 0.999;   // beyond it an axle slides
constexpr double kLeastUse = 1e-6;   // below it its curve is its tangent
constexpr double kLeastLoad = 0.05;  // of that at rest: a lifted axle
constexpr double kRealTyre = 1.5;    // shape of the curve where the car's is not a magic formula
constexpr double kMostAngle = 1.57;  // [rad] c arctan(z / c) ends there

}  // namespace

BrakingStability::BrakingStability(const VehicleParams& car, double most_pole) noexcept
    : car_(car), friction_(car.cornering_friction()) {
  const double front = car.rear_axle / car.wheelbase();
  const double rear = car.front_axle / car.wheelbase();
  const double transfer = car.height * car.load_constant / kGravity;
  const double coupling = std::sqrt(car.friction_coupling);
  front_ = {car.cornering_front, front, transfer / car.rear_axle, coupling * car.brake_share_front / front};
  rear_ = {car.cornering_rear, rear, -transfer / car.front_axle,
           coupling * (1.0 - car.brake_share_front) / rear};
  if (!(car.friction_coupling > 0.0)) return;
  for (int i = 0; i < kSpeeds; ++i) {
    const double v = kLeastSpeed + i * kSpeedStep;
    for (int k = 0; k < kUses; ++k) {
      const double use = k / (kUses - 1.0);
      double low = 0.0;
      double high = friction_ * car.load(v);
      if (pole(v, use, high) <= most_pole) low = high;
      for (int turn = 0; turn < kHalvings && low < high; ++turn) {
        const double middle = 0.5 * (low + high);
        (pole(v, use, middle) <= most_pole ? low : high) = middle;
      }
      most_[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] = low;
    }
  }
}

double BrakingStability::slope(const Axle& axle, double use, double force_over_load) const noexcept {
  const double load = std::max(1.0 + axle.transfer * force_over_load, kLeastLoad);
  const double grip = load * (1.0 + car_.load_sensitivity * (1.0 - load));
  const double across = use / grip;
  const double along = axle.pull * force_over_load / (friction_ * grip);
  const double all = hypot(across, along);
  const double at_rest = axle.cornering * axle.share * grip;
  if (all < kLeastUse) return at_rest;
  if (all > kMostUse) return 0.0;
  // Tangent and secant of sin(c arctan(z / c)) where it is `all`.
  const double shape = car_.tire_shape > 0.0 ? car_.tire_shape : kRealTyre;
  const double angle = std::min(asin(all) / shape, kMostAngle);
  const double cosine = cos(angle);
  const double tangent = std::sqrt(1.0 - all * all) * cosine * cosine;
  const double secant = all * cosine / (shape * sin(angle));
  return at_rest * all * all / (along * along / secant + across * across / tangent);
}

double BrakingStability::pole(double v, double use, double force) const noexcept {
  const double load = car_.load(v);
  const double front = load * slope(front_, use, force / load);
  const double rear = load * slope(rear_, use, force / load);
  if (!(rear > 0.0)) return std::numeric_limits<double>::infinity();
  return yaw_pole(car_, v, {front, rear});
}

double BrakingStability::most_braking(double v, double use) const noexcept {
  if (!(car_.friction_coupling > 0.0)) return std::numeric_limits<double>::infinity();
  const double row = std::clamp((v - kLeastSpeed) / kSpeedStep, 0.0, kSpeeds - 1.0);
  const double column = std::clamp(use, 0.0, 1.0) * (kUses - 1);
  const auto i = std::min(static_cast<std::size_t>(row), static_cast<std::size_t>(kSpeeds - 2));
  const auto k = std::min(static_cast<std::size_t>(column), static_cast<std::size_t>(kUses - 2));
  const double up = row - static_cast<double>(i);
  const double on = column - static_cast<double>(k);
  const auto between = [&](const std::array<double, kUses>& at) { return at[k] + on * (at[k + 1] - at[k]); };
  return between(most_[i]) + up * (between(most_[i + 1]) - between(most_[i]));
}

}  // namespace chicane::model
