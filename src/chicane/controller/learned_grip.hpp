// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "chicane/controller/controller.hpp"
#include "chicane/model/stability.hpp"
#include "chicane/tracking/grip_estimator.hpp"

namespace chicane::controller {

/// The grip that a car is raced with when nobody is sure of it: of the model, which begins as configured
/// and follows what the tyres show, and of the plan, which is made for what may be relied on
/// (docs/racing.md). Shares of the configured grip. One thread; allocates nothing.
class LearnedGrip {
 public:
  static constexpr double kStep =
      0.03;  ///< the model, and a plan upwards, follow where the grip differs by more
  static constexpr double kStepDown = 0.015;   ///< a plan downwards
  static constexpr double kOtherGrip = 0.055;  ///< difference to the configured grip that rules a slide out
  static constexpr double kOtherCar = 0.03;    ///< sure difference of the estimate that does so for the run
  static constexpr double kSlidesOn = 0.01;    ///< more delay that a lap which slides may have [s]

  explicit LearnedGrip(const model::PredictionModel& configured) noexcept : estimator_{configured} {}

  /// Sets the configured car. Takes some 0.1 ms (model::SlidingBound).
  void configure(const model::VehicleParams& configured) noexcept {
    longest_delay_ = model::SlidingBound::longest_delay(configured);
  }
  /// Nothing is known; begin() has to follow.
  void forget() noexcept {
    share_ = 1.0;
    unsure_ = 0.0;
    is_shown_ = is_other_ = false;
  }
  /// The estimate begins anew where `from` is, with the model as it is now.
  void begin(const tracking::StateEstimator& from, const model::PredictionModel& model) noexcept {
    estimator_.begin(from, model);
  }
  /// What has changed by a measurement. After kModel the model has to follow share(), and then begin().
  enum class Change { kNothing, kShown, kModel };
  [[nodiscard]] Change see(const model::Measurement& now, const tracking::CommandHistory& sent) noexcept {
    estimator_.see(now, sent);
    if (!estimator_.is_known()) return Change::kNothing;
    is_other_ = is_other_ || std::fabs(mean() - 1.0) - unsure() > kOtherCar;
    const double share = estimator_.differs(kStep) ? rounded(share_ * estimator_.share()) : share_;
    if (share == share_) return std::exchange(is_shown_, true) ? Change::kNothing : Change::kShown;
    is_shown_ = true;
    unsure_ = 2.0 * share_ * estimator_.deviation();
    share_ = share;
    return Change::kModel;
  }
  /// Of the model.
  [[nodiscard]] double share() const noexcept { return share_; }
  /// Present estimate of the grip and its deviation; NaN before anything is known.
  [[nodiscard]] Estimate estimate() const noexcept {
    if (!estimator_.is_known()) return {};
    return {share_ * estimator_.share(), share_ * estimator_.deviation()};
  }
  /// Whether the tyres have shown anything yet.
  [[nodiscard]] bool is_shown() const noexcept { return is_shown_; }
  /// Whether the car is so close to its configuration, and answered so soon and surely, that a lap planned
  /// for `grip` may slide (docs/limit.md, eq. 19). `delay`: assumed from a measurement to its command's
  /// effect [s]; `slides`: it does already.
  [[nodiscard]] bool may_slide(double grip, double delay, bool slides) const noexcept {
    const double answered = delay + estimator_.interval() + estimator_.unsure_time();
    return is_shown_ && std::fabs(grip - 1.0) < kOtherGrip && !is_other_ &&
           answered < longest_delay_ + (slides ? kSlidesOn : 0.0);
  }
  /// Grip that may be relied on: the estimate less two standard deviations. Pre: is_shown().
  [[nodiscard]] double lower() const noexcept { return rounded(mean() - unsure()); }
  /// The grip to plan for where there is a plan for `planned`: what may be relied on where that is more, what
  /// the tyres show where that is surely less. A plan of less grip has to be braked down to, wherever the car
  /// is: it takes more than doubt, and asks for no more than was seen. Pre: is_shown().
  [[nodiscard]] double for_plan(double planned) const noexcept {
    if (lower() > planned + kStep) return lower();
    return mean() + unsure() < planned - kStepDown ? rounded(mean()) : planned;
  }

 private:
  [[nodiscard]] double mean() const noexcept {
    return estimator_.is_known() ? share_ * estimator_.share() : share_;
  }
  /// Two standard deviations of mean().
  [[nodiscard]] double unsure() const noexcept {
    return estimator_.is_known() ? 2.0 * share_ * estimator_.deviation() : unsure_;
  }
  /// In hundredths. Nearly one is one: a car with the configured grip ends with the plan that
  /// it would have had without learning. A little more may be the model's error: `udacity`, with its
  /// configured grip, shows 1.06 on circuits of 48 m/s (docs/measured/limit.md).
  [[nodiscard]] static double rounded(double share) noexcept {
    constexpr double kLittleLess = 0.02, kLittleMore = 0.075;
    const bool is_configured = share >= 1.0 - kLittleLess && share <= 1.0 + kLittleMore;
    return is_configured ? 1.0 : std::floor(100.0 * share + 0.5) / 100.0;
  }

  tracking::GripEstimator estimator_;
  double longest_delay_ = 0.0;  ///< longest with which the configured car may slide [s]
  double share_ = 1.0;
  double unsure_ = 0.0;  ///< two standard deviations of share_ when it was found
  bool is_shown_ = false;
  bool is_other_ = false;  ///< the car has shown another grip than configured
};

}  // namespace chicane::controller
