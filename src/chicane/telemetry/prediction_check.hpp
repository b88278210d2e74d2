// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "chicane/base/vec2.hpp"
#include "chicane/controller/controller.hpp"

namespace chicane::telemetry {

/// Compares plans with the motion that followed: of every plan it keeps where the car is to be one control
/// period after the plan's beginning, that is one delay and one period after the measurement. Between two
/// such places the predicted position is on the straight line (a sagitta of 4 mm at 30 m/s on a radius of 50
/// m). No allocation; one thread.
class PredictionCheck {
 public:
  void reset() noexcept { count_ = 0; }

  /// A plan of this cycle. An empty one discards the predictions before it.
  void add(const controller::Plan& plan, double period) noexcept {
    if (plan.size < 2) return reset();
    const double time = plan.points[0].time + period;
    if (count_ > 0 && !(time > at(count_ - 1).time)) reset();
    int i = 0;
    while (i + 2 < plan.size && point(plan, i + 1).time < time) ++i;
    const controller::PlanPoint& from = point(plan, i);
    const controller::PlanPoint& to = point(plan, i + 1);
    const double share = (time - from.time) / (to.time - from.time);
    if (count_ == kCapacity) {
      first_ = (first_ + 1) % kCapacity;
      --count_;
    }
    at(count_++) = {time, {from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)}};
  }

  /// Distance of `position` at `time` [s] from the one predicted for it [m]; NaN when there is none. Times do
  /// not decrease between resets.
  [[nodiscard]] double error(double time, const Vec2& position) noexcept {
    constexpr double kRounding = 1e-9;  // sums of step lengths round
    while (count_ > 1 && at(1).time <= time + kRounding) {
      first_ = (first_ + 1) % kCapacity;
      --count_;
    }
    if (count_ < 2 || time < at(0).time - kRounding) return std::numeric_limits<double>::quiet_NaN();
    const double share = (time - at(0).time) / (at(1).time - at(0).time);
    return (at(0).place + share * (at(1).place - at(0).place) - position).norm();
  }

 private:
  struct Prediction {
    double time = 0.0;
    Vec2 place{};
  };
  static constexpr std::size_t kCapacity = 256;  // delays up to 0.5 s at periods down to 5 ms

  [[nodiscard]] static const controller::PlanPoint& point(const controller::Plan& plan, int i) noexcept {
    return plan.points[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] Prediction& at(std::size_t i) noexcept { return predictions_[(first_ + i) % kCapacity]; }

  std::array<Prediction, kCapacity> predictions_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace chicane::telemetry
