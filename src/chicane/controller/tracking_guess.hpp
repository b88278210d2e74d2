// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/model/actuator.hpp"
#include "chicane/model/stability.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/road/reference_line.hpp"
#include "chicane/tracking/state_estimator.hpp"
#include "chicane/tracking/tracking_problem.hpp"
#include "chicane/tracking/tracking_solver.hpp"

/// The first guess of `tracking-mpc` where it has no answer to go on from.

namespace chicane::controller {

/// Inputs towards the line in state x, on the road as stage k of `problem` sees it.
[[nodiscard]] inline tracking::TrackingProblem::Input path_law(
    const tracking::TrackingProblem& problem, int k, const tracking::TrackingProblem::State& x) noexcept {
  using Problem = tracking::TrackingProblem;
  const double v = std::max(x[Problem::kVx], 1.0);
  const double curvature = problem.road.curvature.at(k) - x[Problem::kD] / (v * v) - 1.4 * x[Problem::kE] / v;
  return {problem.model->vehicle().wheelbase() * curvature, problem.road.speed.at(k) - x[Problem::kVx]};
}

/// Pulls a guess back that is far from the road: no place to linearise.
inline void keep_sane(tracking::TrackingProblem::State& x) noexcept {
  using Problem = tracking::TrackingProblem;
  x[Problem::kD] = std::clamp(x[Problem::kD], -5.0, 5.0);
  x[Problem::kE] = std::clamp(x[Problem::kE], -0.6, 0.6);
  x[Problem::kVx] = std::max(x[Problem::kVx], 0.0);
}

/// Adds what the steer helper leaves out along the guess `along` to what disturbs the stages of `problem`: a
/// change of v_y where the heading passes the gap, divided between the ends of the stages around it
/// (docs/limit.md, eq. 12). `s`: of the car on `line` [m].
inline void mind_helper_gap(tracking::TrackingProblem& problem, const tracking::TrackingTrajectory& along,
                            const road::ReferenceLine& line, double s) noexcept {
  using Problem = tracking::TrackingProblem;
  const model::VehicleParams& car = problem.model->vehicle();
  if (!(car.helper_gap > 0.0)) return;
  const auto heading = [&](std::size_t i) {
    return line.at(s + along.x[i][Problem::kS]).heading + along.x[i][Problem::kE];
  };
  double from = heading(0);
  for (std::size_t i = 0; i < static_cast<std::size_t>(along.horizon); ++i) {
    const double to = from + angle_difference(heading(i + 1), from);
    if (const double share = model::helper_gap_within(from, to); share > 0.0) {
      const auto& x = along.x[i];
      const double push = -model::helper_gap_turn(car, x[Problem::kR]) * x[Problem::kVx];
      const double of_this = i == 0 ? 1.0 : share;
      problem.road.pushed_vy[i] += of_this * push;
      if (i > 0) problem.road.pushed_vy[i - 1] += (1.0 - of_this) * push;
    }
    from = to;
  }
}

/// Expresses the states of an answer along another line, so that it goes on as the first guess there: a guess
/// made newly at the limit of the tyres is one from which a step does not converge. `plan`: where the states
/// are in the world. `far` [m]: beside the line. False, and an answer of no use, where one is farther.
/// Allocates nothing.
[[nodiscard]] inline bool move_to_line(const road::ReferenceLine& line, const Plan& plan, double reach,
                                       double far, tracking::TrackingTrajectory& answer) noexcept {
  using Problem = tracking::TrackingProblem;
  if (line.is_empty() || plan.size != answer.horizon + 1) return false;
  double last = 0.0, driven = 0.0;
  for (int k = 0; k <= answer.horizon; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const PlanPoint& point = plan.points[i];
    const road::ReferenceLine::Projection place =
        line.find({point.x, point.y}, point.psi, reach, k > 0 ? &last : nullptr, far);
    if (!(place.distance < far)) return false;
    if (k > 0) driven += line.is_closed() ? std::remainder(place.s - last, line.length()) : place.s - last;
    answer.x[i][Problem::kS] = driven;
    answer.x[i][Problem::kD] = place.d;
    answer.x[i][Problem::kE] = angle_difference(point.psi, line.at(place.s).heading);
    last = place.s;
  }
  return true;
}

/// How far beside `lap` [m] the plan of the next 1.5 s leads at most. Of the first lap (`now` is null) the
/// car's own place counts: the line through waypoints leaves grip to join it with, and crosses it before
/// long. 0 where `lap` is to be taken up at once, since it has less grip or slip, which has to be braked for.
/// Allocates nothing.
[[nodiscard]] inline double beside_lap(const road::RacingRoad& lap, const road::RacingRoad* now,
                                       const Plan& plan, double reach, double far) noexcept {
  const double joining_time = now == nullptr ? 0.0 : 1.5;  // [s]
  if (lap.line().is_empty() || (now != nullptr && (lap.grip() < now->grip() || lap.slip() < now->slip())))
    return 0.0;
  double most = 0.0, last = 0.0;
  for (int k = 0; k < plan.size; ++k) {
    const PlanPoint& point = plan.points[static_cast<std::size_t>(k)];
    if (point.time > plan.points[0].time + joining_time) break;
    const road::ReferenceLine::Projection place =
        lap.line().find({point.x, point.y}, point.psi, reach, k > 0 ? &last : nullptr, far);
    most = std::max(most, place.distance);
    last = place.s;
  }
  return most;
}

/// How long something has not been there that was. One thread; allocates nothing.
struct Absence {
  double longest;      ///< that is borne [s]
  double since = 0.0;  ///< last there [s]
  bool was_there = false;
  bool is_long = false;

  void note(bool is_there, double time) noexcept {
    if (is_there) since = time;
    was_there = was_there || is_there;
    is_long = was_there && std::isfinite(time) && time - since > longest;
  }
  void reset() noexcept { *this = {.longest = longest}; }
};

/// How much slip of the rear tyres a lap keeps back for the error of the estimated slip (docs/racing.md, eq.
/// 9): the controller steers for that error, and takes it back later by the delay and by the time that the
/// steering needs. One thread; allocates nothing.
class SlipReserve {
 public:
  static constexpr double kPerSecond = 67.0;  ///< deviations kept back for each second of lateness [1/s]
  static constexpr double kStep = 0.05;       ///< shares are multiples of it
  static constexpr double kMost = 0.4;        ///< largest share kept back
  static constexpr double kFast = 20.0;       ///< [m/s] below which a car takes an error back more easily
  static constexpr double kNothing = 0.1;     ///< smallest share kept back

  void forget() noexcept { *this = {}; }
  /// The estimate of this cycle; corners count. `delay`: from the measurement to its command's effect [s].
  void see(const tracking::StateEstimator& car, double time, double delay) noexcept {
    const double elapsed = time - std::exchange(time_, time);
    const model::State& now = car.state();
    if (!(std::fabs(now.vx * now.r) >= tracking::GripEstimator::kLeast)) return;
    if (!(elapsed > 0.0 && elapsed < kLongestGap)) return;
    const model::PredictionModel& model = car.model();
    const double peak = model.peak_slip_rear();
    const double late = delay + elapsed + 0.5 * peak / model.vehicle().steer_rate_limit;
    const double deviation =
        std::sqrt(car.errors().slide_variance(model.vehicle().rear_axle)) / (now.vx * peak);
    const double kept = kPerSecond * late * std::min(now.vx / kFast, 1.0) * deviation;
    if (!std::isfinite(kept)) return;
    seen_ = std::min(seen_ + elapsed, kMemory);
    kept_ += elapsed / seen_ * (std::min(kept, 1.0) - kept_);
  }
  /// The share of the tyres' slip to plan a lap with where there is one with `planned`.
  [[nodiscard]] double for_plan(double planned) const noexcept {
    const double least = planned < 1.0 ? 0.5 * kNothing : kNothing;
    const double share = kept_ < least ? 1.0 : 1.0 - std::min(kept_, kMost);
    const bool is_near = share > planned - kStep && share < planned + 2.0 * kStep;
    return is_near ? planned : std::floor(share / kStep + 0.5) / std::floor(1.0 / kStep + 0.5);
  }

 private:
  static constexpr double kMemory = 10.0;      ///< cornering that the mean spans [s]
  static constexpr double kLongestGap = 0.25;  ///< between cycles [s]
  double kept_ = 0.0;                          ///< share of the slip that is kept back, mean over kMemory
  double time_ = 0.0;                          ///< last cycle [s]
  double seen_ = 0.0;                          ///< cornering so far, at most kMemory [s]
};

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
