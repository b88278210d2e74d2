// SPDX-License-Identifier: MIT
#include "chicane/controller/fallback.hpp"

#include <algorithm>
#include <cmath>

namespace chicane::controller {
namespace {

/// Cycle length assumed when the clock cannot be believed [s].
constexpr double kAssumedCycle = 0.1;

bool is_finite(const PlanPoint& point) noexcept {
  return std::isfinite(point.time) && std::isfinite(point.command.steer) &&
         std::isfinite(point.command.throttle);
}

}  // namespace

void Fallback::accept(const Plan& plan) noexcept {
  const int size = std::clamp(plan.size, 0, Plan::kCapacity);
  plan_size_ = 0;
  for (int i = 0; i < size; ++i) {
    const PlanPoint& point = plan.points[static_cast<std::size_t>(i)];
    if (!is_finite(point)) break;
    const double steer = std::clamp(point.command.steer, -vehicle_.steer_limit, vehicle_.steer_limit);
    const double throttle = std::clamp(point.command.throttle, -1.0, 1.0);
    plan_[static_cast<std::size_t>(plan_size_++)] = {point.time, {steer, throttle}};
  }
  if (plan_size_ == 0) return;
  good_time_ = last_time_ = plan_[0].time;
  last_steer_ = plan_[0].command.steer;
  has_time_ = true;
}

Fallback::Answer Fallback::command(double act_time, const model::Measurement& now) noexcept {
  if (!has_time_) {
    good_time_ = last_time_ = std::isfinite(act_time) ? act_time : 0.0;
    has_time_ = true;
  } else {
    const bool is_credible = std::isfinite(act_time) && act_time >= last_time_;
    last_time_ = is_credible ? act_time : last_time_ + kAssumedCycle;
  }
  const double age = last_time_ - good_time_;

  if (age <= kPlanAge) {
    if (const model::Command* intended = planned(last_time_)) {
      last_steer_ = intended->steer;
      return {*intended, Rung::kShiftedPlan};
    }
  }
  const double fade = std::isfinite(now.speed) ? std::clamp(now.speed / kFadeSpeed, 0.0, 1.0) : 1.0;
  const double braking = vehicle_.brake_throttle_limit * fade;
  if (age < kHoldAge) return {{last_steer_, -kGentleBraking * braking}, Rung::kHoldAndBrake};
  return {{last_steer_, -braking}, Rung::kBrake};
}

void Fallback::reset() noexcept {
  plan_size_ = 0;
  has_time_ = false;
  last_steer_ = 0.0;
}

/// The command planned for `time`; nullptr when the plan ends before.
const model::Command* Fallback::planned(double time) const noexcept {
  if (plan_size_ == 0 || time > plan_[static_cast<std::size_t>(plan_size_ - 1)].time) return nullptr;
  int i = 0;
  while (i + 1 < plan_size_ && plan_[static_cast<std::size_t>(i + 1)].time <= time) ++i;
  return &plan_[static_cast<std::size_t>(i)].command;
}

}  // namespace chicane::controller
