// SPDX-License-Identifier: MIT
// Parts of `tracking-mpc` around its solver: a first guess without a last answer, the last answer moved to
// another line, and the terms that it learns for planned laps (grip of the car, reserve of slip).
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

namespace chicane::controller {

/// Steering angle [rad] and acceleration [m/s²] that lead state `x` to the line, on the road of stage `k` of
/// `problem`: across the road a spring and a damper (1 rad/s, damping ratio 0.7), and the speed error within
/// a second. Chosen: smooth enough as a first guess.
[[nodiscard]] inline tracking::TrackingProblem::Input path_law(
    const tracking::TrackingProblem& problem, int k, const tracking::TrackingProblem::State& x) noexcept {
  using Problem = tracking::TrackingProblem;
  const double v = std::max(x[Problem::kVx], 1.0);
  const double curvature = problem.road.curvature.at(k) - x[Problem::kD] / (v * v) - 1.4 * x[Problem::kE] / v;
  return {problem.model->vehicle().wheelbase() * curvature, problem.road.speed.at(k) - x[Problem::kVx]};
}

/// Limits a state of a guess to the neighbourhood of the line and to driving forwards: farther away a
/// linearisation is useless.
inline void clamp_to_road(tracking::TrackingProblem::State& x) noexcept {
  using Problem = tracking::TrackingProblem;
  constexpr double kFarthest = 5.0, kMostTurned = 0.6;  // [m], [rad]; chosen
  x[Problem::kD] = std::clamp(x[Problem::kD], -kFarthest, kFarthest);
  x[Problem::kE] = std::clamp(x[Problem::kE], -kMostTurned, kMostTurned);
  x[Problem::kVx] = std::max(x[Problem::kVx], 0.0);
}

/// Adds the gap of the plant's steer helper to the disturbances of `problem` (docs/limit.md, eq. 12): a
/// change of v_y where the yaw passes the gap along the guess `along`, divided between the ends of the stages
/// around that place. `s`: arc length of the car on `line` [m].
inline void add_helper_gap(tracking::TrackingProblem& problem, const tracking::TrackingTrajectory& along,
                           const road::ReferenceLine& line, double s) noexcept {
  using Problem = tracking::TrackingProblem;
  const model::VehicleParams& car = problem.model->vehicle();
  if (!(car.helper_gap > 0.0)) return;
  const auto yaw = [&](std::size_t i) {
    return line.at(s + along.x[i][Problem::kS]).heading + along.x[i][Problem::kE];
  };
  double from = yaw(0);
  for (std::size_t i = 0; i < static_cast<std::size_t>(along.horizon); ++i) {
    const double to = from + angle_difference(yaw(i + 1), from);
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

/// Transforms an answer to coordinates along another line. The result is the first guess there, because at
/// the limit of the tyres a step does not converge from a new guess. `plan`: the answer in W; `reach`: as in
/// road::ReferenceLine::find() [m]. False, and `answer` is not usable, if a state is farther than `far` [m]
/// from the line. Allocates nothing.
[[nodiscard]] inline bool move_to_line(const road::ReferenceLine& line, const Plan& plan, double reach,
                                       double far, tracking::TrackingTrajectory& answer) noexcept {
  using Problem = tracking::TrackingProblem;
  if (line.is_empty() || plan.size != answer.horizon + 1) return false;
  double last = 0.0, driven = 0.0;  // arc length of the last state on the line, and from the first state [m]
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

/// Largest distance of the plan from the line of `lap` while the car would join it [m]. For a first planned
/// lap (`now` is null) only the present place counts, because the line through waypoints leaves grip to join
/// the lap. 0 for a lap of less grip or slip than `now`: the car has to brake for it, and changes to it at
/// once. `reach`, `far`: as in move_to_line(). Allocates nothing.
[[nodiscard]] inline double beside_lap(const road::RacingRoad& lap, const road::RacingRoad* now,
                                       const Plan& plan, double reach, double far) noexcept {
  const double joining_time = now == nullptr ? 0.0 : 1.5;  // [s] chosen
  if (lap.line().is_empty() ||
      (now != nullptr && (lap.terms().grip < now->terms().grip || lap.terms().slip < now->terms().slip)))
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

/// Timer of an input that stopped arriving. One thread; allocates nothing.
struct Absence {
  double longest;          ///< tolerated absence [s]
  double since = 0.0;      ///< time of the last presence [s]
  bool was_there = false;  ///< present at least once
  bool is_long = false;    ///< absent for longer than tolerated

  /// Takes in one cycle at `time` [s].
  void note(bool is_there, double time) noexcept {
    if (is_there) since = time;
    was_there = was_there || is_there;
    is_long = was_there && std::isfinite(time) && time - since > longest;
  }
  void reset() noexcept { *this = {.longest = longest}; }
};

/// Slip of the rear tyres that a planned lap keeps in reserve for the error of the estimated slip
/// (docs/racing.md, eq. 9): the car follows that error until delay and steering rate allow a correction. One
/// thread; allocates nothing.
class SlipReserve {
  /// Standard deviations in reserve per second of delay; chosen by runs, docs/racing.md.
 public:
  static constexpr double kPerSecond = 67.0;
  static constexpr double kStep = 0.05;    ///< step of shares in plans: few new plans; chosen
  static constexpr double kMost = 0.4;     ///< largest reserve as share of the slip; chosen
  static constexpr double kFast = 20.0;    ///< speed below which the reserve falls with it [m/s]; chosen
  static constexpr double kNothing = 0.1;  ///< reserve below which a plan keeps none; chosen

  /// Begins again.
  void forget() noexcept { *this = {}; }
  /// Takes in the estimate of one cycle, if the car corners. `delay`: from a measurement to the effect of its
  /// command [s].
  void see(const tracking::StateEstimator& car, double time, double delay) noexcept {
    const double elapsed = time - std::exchange(time_, time);
    const model::State& now = car.state();
    if (!(std::fabs(now.vx * now.r) >= tracking::GripEstimator::kLeast)) return;
    if (!(elapsed > 0.0 && elapsed < kLongestGap)) return;
    const model::PredictionModel& model = car.model();
    const double peak = model.peak_slip_rear();
    const double late =
        delay + elapsed + 0.5 * peak / model.vehicle().steer_rate_limit;  // until corrected [s]
    const double deviation =
        std::sqrt(car.errors().slide_variance(model.vehicle().rear_axle)) / (now.vx * peak);
    const double kept = kPerSecond * late * std::min(now.vx / kFast, 1.0) * deviation;
    if (!std::isfinite(kept)) return;
    seen_ = std::min(seen_ + elapsed, kMemory);
    kept_ += elapsed / seen_ * (std::min(kept, 1.0) - kept_);
  }
  /// Share of the tyres' slip for the next planned lap; `planned`: share of the present one.
  [[nodiscard]] double for_plan(double planned) const noexcept {
    const double least = planned < 1.0 ? 0.5 * kNothing : kNothing;
    const double share = kept_ < least ? 1.0 : 1.0 - std::min(kept_, kMost);
    const bool is_near = share > planned - kStep && share < planned + 2.0 * kStep;
    return is_near ? planned : std::floor(share / kStep + 0.5) / std::floor(1.0 / kStep + 0.5);
  }

  /// Time of cornering in the mean [s]; chosen: some bends.
 private:
  static constexpr double kMemory = 10.0;
  static constexpr double kLongestGap = 0.25;  ///< longest time between two cycles that count [s]; chosen
  double kept_ = 0.0;                          ///< reserve as share of the slip, mean over kMemory
  double time_ = 0.0;                          ///< time of the last cycle [s]
  double seen_ = 0.0;                          ///< time of cornering so far, at most kMemory [s]
};

/// Grip of a racing car, learned from the forces of its tyres (docs/racing.md): the estimate for the model,
/// and its lower bound for planned laps. All grips are shares of the configured grip. One thread; allocates
/// nothing.
class LearnedGrip {
 public:
  // Chosen, with the reasons in docs/racing.md.
  static constexpr double kStep = 0.03;        ///< least change of the model, and of a plan upwards
  static constexpr double kStepDown = 0.015;   ///< least change of a plan downwards
  static constexpr double kOtherGrip = 0.055;  ///< difference to the configured grip that forbids slides
  static constexpr double kOtherCar = 0.03;  ///< significant difference that forbids slides for the whole run
  static constexpr double kSlidesOn = 0.01;  ///< hysteresis of the longest delay with slides [s]

  explicit LearnedGrip(const model::PredictionModel& configured) noexcept : estimator_{configured} {}

  /// Sets the configured car. Takes some 0.1 ms (model::SlidingBound).
  void configure(const model::VehicleParams& configured) noexcept {
    longest_delay_ = model::SlidingBound::longest_delay(configured);
  }
  /// Forgets the estimate. begin() must follow.
  void forget() noexcept {
    share_ = 1.0;
    unsure_ = 0.0;
    is_shown_ = is_other_ = false;
  }
  /// Restarts the estimate at the state of `from`, with the present model.
  void begin(const tracking::StateEstimator& from, const model::PredictionModel& model) noexcept {
    estimator_.begin(from, model);
  }
  /// Result of see(): no change, the first estimate, or another grip of the model. After kModel the caller
  /// sets the model to share() and calls begin().
  enum class Change { kNothing, kShown, kModel };
  /// Takes in one cycle.
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
  /// Grip of the model.
  [[nodiscard]] double share() const noexcept { return share_; }
  /// Estimate of the grip; NaN before the tyres have shown any.
  [[nodiscard]] Estimate estimate() const noexcept {
    if (!estimator_.is_known()) return {};
    return {share_ * estimator_.share(), share_ * estimator_.deviation()};
  }
  /// Whether there is an estimate.
  [[nodiscard]] bool is_shown() const noexcept { return is_shown_; }
  /// Whether a lap planned for `grip` may slide (docs/limit.md, eq. 19): the grip is close to the configured
  /// one, and the delay is short enough. `delay`: configured delay from a measurement to the effect of its
  /// command [s]; `slides`: the present lap slides.
  [[nodiscard]] bool may_slide(double grip, double delay, bool slides) const noexcept {
    const double answered = delay + estimator_.interval() + estimator_.unsure_time();
    return is_shown_ && std::fabs(grip - 1.0) < kOtherGrip && !is_other_ &&
           answered < longest_delay_ + (slides ? kSlidesOn : 0.0);
  }
  /// Lower bound of the grip: the estimate less two standard deviations. Pre: is_shown().
  [[nodiscard]] double lower() const noexcept { return rounded(mean() - unsure()); }
  /// Grip for the next planned lap; `planned`: grip of the present one. It rises to the lower bound, and
  /// falls only to a significantly lower estimate, because a plan of less grip makes the car brake at once.
  /// Pre: is_shown().
  [[nodiscard]] double for_plan(double planned) const noexcept {
    if (lower() > planned + kStep) return lower();
    return mean() + unsure() < planned - kStepDown ? rounded(mean()) : planned;
  }

 private:
  /// Estimated grip; share_ without an estimate.
  [[nodiscard]] double mean() const noexcept {
    return estimator_.is_known() ? share_ * estimator_.share() : share_;
  }
  /// Two standard deviations of mean().
  [[nodiscard]] double unsure() const noexcept {
    return estimator_.is_known() ? 2.0 * share_ * estimator_.deviation() : unsure_;
  }
  /// Rounds to hundredths, and values near 1 to 1: a car with the configured grip keeps its plan. The
  /// interval above 1 covers the error of the model: measured, `udacity` shows 1.06 with exactly its
  /// configured grip on circuits of 48 m/s (docs/measured/limit.md).
  [[nodiscard]] static double rounded(double share) noexcept {
    constexpr double kLittleLess = 0.02, kLittleMore = 0.075;
    const bool is_configured = share >= 1.0 - kLittleLess && share <= 1.0 + kLittleMore;
    return is_configured ? 1.0 : std::floor(100.0 * share + 0.5) / 100.0;
  }

  tracking::GripEstimator estimator_;
  double longest_delay_ = 0.0;  ///< longest delay with which the configured car may slide [s]
  double share_ = 1.0;          ///< grip of the model
  double unsure_ = 0.0;         ///< two standard deviations of share_ when it was estimated
  bool is_shown_ = false;       ///< there is an estimate
  bool is_other_ = false;       ///< the car has shown another grip than configured
};

}  // namespace chicane::controller
