// SPDX-License-Identifier: MIT
#include "chicane/safety/fallback.hpp"

#include <algorithm>
#include <cmath>

#include "chicane/base/math.hpp"
#include "chicane/model/actuator.hpp"

namespace chicane::safety {
namespace {

// Origins (chosen: by trial, see Guard):
// - Derived: kFarthestStep (kFastest for kPlanAge).
// - Chosen: kFastest (twice what indy reaches), kTrustedBraking (docs/guard.md, eq. 16), kAssumedCycle
//   (Policy::hold).
constexpr double kAssumedCycle = 0.1;    // [s] when the clock is not plausible
constexpr double kFarthestStep = 100.0;  // [m] between two points of a plan; more is no plan
constexpr double kFastest = 200.0;       // [m/s]
constexpr double kTrustedBraking = 0.5;  // share of the braking asked for that a blind car counts on

bool is_finite(const controller::PlanPoint& point) noexcept {
  return std::isfinite(point.time) && std::isfinite(point.command.steer) &&
         std::isfinite(point.command.throttle);
}

}  // namespace

void Fallback::accept(const controller::Plan& plan) noexcept {
  const int size = std::clamp(plan.size, 0, controller::Plan::kCapacity);
  plan_size_ = 0;
  for (int i = 0; i < size; ++i) {
    const controller::PlanPoint& point = plan.points[static_cast<std::size_t>(i)];
    if (!is_finite(point)) break;
    const double steer = std::clamp(point.command.steer, -vehicle_.steer_limit, vehicle_.steer_limit);
    const double throttle = std::clamp(point.command.throttle, -1.0, 1.0);
    double distance = 0.0;
    if (i > 0) {
      const controller::PlanPoint& before = plan.points[static_cast<std::size_t>(i - 1)];
      const double step = hypot(point.x - before.x, point.y - before.y);
      distance = plan_[static_cast<std::size_t>(i - 1)].distance + (step < kFarthestStep ? step : 0.0);
    }
    const double speed = std::isfinite(point.speed) ? std::clamp(point.speed, 0.0, kFastest) : 0.0;
    plan_[static_cast<std::size_t>(plan_size_++)] = {point.time, distance, speed, {steer, throttle}};
  }
  if (plan_size_ > 0) begin_plan();
}

void Fallback::accept(const model::Command& command, double time, double speed) noexcept {
  if (!std::isfinite(time) || !std::isfinite(command.steer) || !std::isfinite(command.throttle)) return;
  const double known_speed = std::isfinite(speed) ? std::clamp(speed, 0.0, kFastest) : 0.0;
  const double steer = std::clamp(command.steer, -vehicle_.steer_limit, vehicle_.steer_limit);
  plan_[0] = {time, 0.0, known_speed, {steer, std::clamp(command.throttle, -1.0, 1.0)}};
  plan_size_ = 1;
  begin_plan();
}

/// The plan just accepted is what holds from now on.
void Fallback::begin_plan() noexcept {
  speed_ = plan_[0].speed;
  has_speed_ = true;
  distance_ = 0.0;
  last_throttle_ = plan_[0].command.throttle;
  good_time_ = last_time_ = plan_[0].time;
  last_steer_ = plan_[0].command.steer;
  has_time_ = true;
}

Fallback::Answer Fallback::command(double act_time, const model::Measurement& now) noexcept {
  const double before = last_time_;
  if (!has_time_) {
    good_time_ = last_time_ = std::isfinite(act_time) ? act_time : 0.0;
    has_time_ = true;
  } else {
    const bool is_credible = std::isfinite(act_time) && act_time >= last_time_;
    last_time_ = is_credible ? act_time : last_time_ + kAssumedCycle;
  }
  const double age = last_time_ - good_time_;
  drive_on(age > 0.0 ? last_time_ - before : 0.0, now.speed);

  if (age <= kPlanAge) {
    if (const model::Command* intended = planned(last_time_)) {
      last_steer_ = intended->steer;
      last_throttle_ = intended->throttle;
      return {*intended, controller::Rung::kShiftedPlan};
    }
  }
  const double fade = has_speed_ ? std::clamp(speed_ / kFadeSpeed, 0.0, 1.0) : 1.0;
  const bool is_gentle = age < kHoldAge;
  last_steer_ = steer_along_path();
  last_throttle_ = -(is_gentle ? gentle_share() : 1.0) * vehicle_.brake_throttle_limit * fade;
  return {{last_steer_, last_throttle_},
          is_gentle ? controller::Rung::kHoldAndBrake : controller::Rung::kBrake};
}

/// Speed and distance now, `elapsed` [s] after the command before.
void Fallback::drive_on(double elapsed, double measured_speed) noexcept {
  if (std::isfinite(measured_speed)) {
    speed_ = std::min(std::fabs(measured_speed), kFastest);
    has_speed_ = true;
  } else if (has_speed_) {
    const double trusted = last_throttle_ < 0.0 ? kTrustedBraking : 1.0;
    const double acceleration = trusted * longitudinal_acceleration(vehicle_, last_throttle_, speed_);
    speed_ = std::clamp(speed_ + elapsed * acceleration, 0.0, kFastest);
  }
  distance_ += elapsed * speed_;
}

/// Equation 16 of docs/guard.md.
double Fallback::steer_along_path() const noexcept {
  if (plan_size_ == 0 || plan_[static_cast<std::size_t>(plan_size_ - 1)].distance <= 0.0) return last_steer_;
  int i = 0;
  while (i + 1 < plan_size_ && plan_[static_cast<std::size_t>(i + 1)].distance <= distance_) ++i;
  const Intention& there = plan_[static_cast<std::size_t>(i)];
  const double helped = 1.0 - vehicle_.steer_helper;
  const double compliance = helped * (1.0 / vehicle_.cornering_front - 1.0 / vehicle_.cornering_rear);
  const auto angle_per_curvature = [&](double v) {
    return vehicle_.wheelbase() + compliance * v * v / vehicle_.load(v);
  };
  // A car that oversteers has a speed at which it needs no angle at all: stay away from it.
  const double least = 0.3 * vehicle_.wheelbase();
  const double share =
      std::max(angle_per_curvature(speed_), least) / std::max(angle_per_curvature(there.speed), least);
  return std::clamp(there.command.steer * share, -vehicle_.steer_limit, vehicle_.steer_limit);
}

/// Share of the useful braking that stops the car where the plan ends, at least the gentle one.
double Fallback::gentle_share() const noexcept {
  const double length = plan_size_ > 0 ? plan_[static_cast<std::size_t>(plan_size_ - 1)].distance : 0.0;
  if (length <= 0.0) return kGentleBraking;
  const double most = -longitudinal_acceleration(vehicle_, -vehicle_.brake_throttle_limit, speed_);
  const double needed = speed_ * speed_ / (2.0 * std::max(length - distance_, 1.0));
  return std::clamp(needed / std::max(most, 0.1), kGentleBraking, 1.0);
}

/// The command planned for `time`; nullptr when the plan ends before.
const model::Command* Fallback::planned(double time) const noexcept {
  if (plan_size_ == 0 || time > plan_[static_cast<std::size_t>(plan_size_ - 1)].time) return nullptr;
  int i = 0;
  while (i + 1 < plan_size_ && plan_[static_cast<std::size_t>(i + 1)].time <= time) ++i;
  return &plan_[static_cast<std::size_t>(i)].command;
}

double CommandGate::wheel_after(double elapsed) const noexcept {
  return last_.steer + model::left_by_lag(vehicle_.steer_lag, elapsed) * (wheel_ - last_.steer);
}

model::Command CommandGate::limited(const model::Command& asked, double elapsed) const noexcept {
  model::Command command = asked;
  // Finite first, and explicitly: std::clamp lets a NaN through.
  if (!std::isfinite(command.steer)) command.steer = last_.steer;
  if (!std::isfinite(command.throttle))
    command.throttle = -Fallback::kGentleBraking * vehicle_.brake_throttle_limit;
  command.steer = std::clamp(command.steer, -vehicle_.steer_limit, vehicle_.steer_limit);
  command.throttle = std::clamp(command.throttle, -1.0, 1.0);
  if (!std::isfinite(elapsed) || !(elapsed > 0.0)) return command;
  const double wheel = wheel_after(elapsed);
  const double turned = 1.0 - model::left_by_lag(vehicle_.steer_lag, elapsed);
  const double reach = vehicle_.steer_rate_limit * elapsed / turned;
  command.steer = std::clamp(command.steer, wheel - reach, wheel + reach);
  return command;
}

double drive_to_valid_speed(const model::VehicleParams& car, double v) noexcept {
  constexpr double kExcess = 1.05;   // share of the valid speed
  constexpr double kApproach = 0.5;  // [s] time constant: of the order of steering and drive lags
  return (kExcess * car.valid_speed - v) / kApproach;
}

model::Command CommandGate::pass(const model::Command& asked, double elapsed) noexcept {
  const model::Command sent = limited(asked, elapsed);
  wheel_ = std::isfinite(elapsed) && elapsed > 0.0 ? wheel_after(elapsed) : sent.steer;
  return last_ = sent;
}

}  // namespace chicane::safety
