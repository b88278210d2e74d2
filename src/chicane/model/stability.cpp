// SPDX-License-Identifier: MIT
// Tables of the bounds that keep a car stable for a controller with delay: braking in a bend, and slip of the
// rear tyres beyond their peak.
#include "chicane/model/stability.hpp"

namespace chicane::model {
namespace {

constexpr double kGravity = 9.81;    // [m/s²]
constexpr int kHalvings = 8;         // halvings of the range of forces: error 1/256 of the friction; chosen
constexpr double kMostUse = 0.999;   // use from which on an axle slides; chosen
constexpr double kLeastUse = 1e-6;   // use below which the curve is its tangent; chosen
constexpr double kLeastLoad = 0.05;  // load of a lifted axle, over the load at rest; chosen
constexpr double kRealTyre = 1.5;    // shape for cars without a magic formula: that of the road car
constexpr double kMostAngle = 1.57;  // [rad] limit of arctan(z / c): just below π / 2
constexpr double kStep = 0.01;       // step between tested slips; chosen
constexpr int kFrontSlips = 9;       // front slips at which stability is checked; chosen

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
  const double combined = hypot(across, along);
  const double at_rest = axle.cornering * axle.share * grip;
  if (combined < kLeastUse) return at_rest;
  if (combined > kMostUse) return 0.0;
  // Tangent and secant of sin(c arctan(z / c)) at the slip z for which it is the combined use.
  const double shape = car_.tire_shape > 0.0 ? car_.tire_shape : kRealTyre;
  const double angle = std::min(asin(combined) / shape, kMostAngle);
  const double cosine = cos(angle);
  const double tangent = std::sqrt(1.0 - combined * combined) * cosine * cosine;
  const double secant = combined * cosine / (shape * sin(angle));
  return at_rest * combined * combined / (along * along / secant + across * across / tangent);
}

double BrakingStability::pole(double v, double use, double force) const noexcept {
  const double load = car_.load(v);
  // Share of the load that downforce moves to the front axle.
  const double moved = car_.load_balance * (1.0 - car_.load_constant / load);
  const double front = load * (1.0 + moved / front_.share) * slope(front_, use, force / load);
  const double rear = load * (1.0 - moved / rear_.share) * slope(rear_, use, force / load);
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
    const double z = slip * tan(0.5 * kPi / c);
    return cos(c * atan(z)) / (1.0 + z * z);
  }
  // The original simulator's curve (docs/controller.md, eq. 4a).
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
