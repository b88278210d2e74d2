// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "chicane/model/prediction.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/tracking/error_covariance.hpp"

namespace chicane::tracking {

/// Commands that were sent, with the times from which they act. Fixed memory: the oldest is dropped.
class CommandHistory {
 public:
  void clear() noexcept { count_ = 0; }
  [[nodiscard]] bool is_empty() const noexcept { return count_ == 0; }
  /// `command` acts from `time` [s] on; later commands replace earlier ones that would act later.
  void add(double time, const model::Command& command) noexcept;
  /// A copy whose commands are changed by `change`, at the same times.
  template <class Change>
  [[nodiscard]] CommandHistory changed(const Change& change) const noexcept {
    CommandHistory other = *this;
    for (Entry& entry : other.entries_) entry.command = change(entry.command);
    return other;
  }
  /// Moves all commands by `time` [s], later where positive.
  void delay(double time) noexcept {
    for (Entry& entry : entries_) entry.time += time;
  }
  /// The command acting at `time`; zero before the first.
  [[nodiscard]] model::Command at(double time) const noexcept;
  /// Lowest throttle of those that act between two times [s].
  [[nodiscard]] double lowest_throttle(double from, double until) const noexcept;
  /// Time of the first change of command after `time`, at most `limit` [s].
  [[nodiscard]] double next_change(double time, double limit) const noexcept;

 private:
  struct Entry {
    double time = 0.0;
    model::Command command;
  };
  static constexpr int kCapacity = 128;
  std::array<Entry, kCapacity> entries_{};  ///< ring, ascending in time
  int first_ = 0;
  int count_ = 0;
  [[nodiscard]] const Entry& entry(int i) const noexcept {
    return entries_[static_cast<std::size_t>((first_ + i) % kCapacity)];
  }
};

/// Detects a car that rolls backwards by its displacement, because its speed is measured without a sign.
class DirectionWatch {
 public:
  static constexpr double kPath = 2.0;  ///< way over which the direction is judged [m]
  void reset() noexcept { *this = {}; }
  void see(const model::Measurement& now) noexcept;
  /// Whether the car moved against its heading over the last kPath. False for a car that stands or slides
  /// sideways.
  [[nodiscard]] bool rolls_back() const noexcept { return rolls_back_; }

 private:
  bool has_last_ = false;
  double time_ = 0.0, x_ = 0.0, y_ = 0.0;  ///< last measurement [s, m]
  double path_ = 0.0;                      ///< way by the measured speed [m]
  double along_ = 0.0;                     ///< part of that way along the heading [m]
  bool rolls_back_ = false;
};

/// Accelerations of the car beyond the model, estimated from recent measurements.
struct Disturbance {
  /// Time constant of its decay without measurements [s].
  static constexpr double kTime = 0.5;

  double lateral = 0.0;  ///< change of v_y [m/s²]
  double yaw = 0.0;      ///< change of the yaw rate [rad/s²]

  /// Decay over `dt` [s], to first order in dt.
  void fade(double dt) noexcept {
    const double left = kTime / (kTime + dt);
    lateral *= left;
    yaw *= left;
  }
};

/// Estimate of the car's state, and its prediction for the time at which the next command acts. The
/// prediction model runs with the commands in flight and, if asked, an estimated disturbance; each
/// measurement corrects it. Yaw rate and sideslip, which telemetry does not contain, are estimated here.
class StateEstimator {
 public:
  /// Longest prediction [s]. After a longer silence the estimate restarts.
  static constexpr double kLongestGap = 1.0;

  explicit StateEstimator(const model::PredictionModel& model) noexcept : model_{model} {}
  void reset() noexcept {
    is_started_ = false;
    direction_.reset();
    errors_.reset();
  }
  /// Turns the estimate of a disturbance on or off; off at first.
  void estimate_disturbance(bool is_on) noexcept {
    errors_.estimate_disturbance(is_on);
    is_disturbed_ = is_on;
    now_.disturbance = {};
  }
  /// Turns the model of the steer helper's gap on or off (model/actuator.hpp); off at first.
  void mind_helper_gap(bool is_on) noexcept { minds_gap_ = is_on; }
  /// Averages innovations over `time` [s], whatever the noise; 0, as at first: by the noise.
  void average_over(double time) noexcept { average_ = time; }
  /// Changes the model; the estimate stays.
  void set_model(const model::PredictionModel& model) noexcept { model_ = model; }
  [[nodiscard]] const model::PredictionModel& model() const noexcept { return model_; }

  /// Takes in a measurement. Afterwards state() is the estimate at now.time. Values that are not finite are
  /// replaced by the model's.
  void correct(const model::Measurement& now, const CommandHistory& sent) noexcept;
  [[nodiscard]] const model::State& state() const noexcept { return now_.state; }
  /// Replaces the estimated state, as by another estimator's.
  void set_state(const model::State& state) noexcept { now_.state = state; }
  [[nodiscard]] double time() const noexcept { return time_; }  ///< of state() [s]
  [[nodiscard]] bool is_started() const noexcept { return is_started_; }
  [[nodiscard]] double acceleration() const noexcept { return now_.acceleration; }
  /// Last measurement less its prediction; NaN without one.
  struct Surprise {
    double aside = std::numeric_limits<double>::quiet_NaN();    ///< lateral, left positive [m]
    double heading = std::numeric_limits<double>::quiet_NaN();  ///< [rad]
  };
  [[nodiscard]] const Surprise& surprise() const noexcept { return surprise_; }
  [[nodiscard]] const ErrorCovariance& errors() const noexcept { return errors_; }
  [[nodiscard]] const Disturbance& disturbance() const noexcept { return now_.disturbance; }
  /// Whether the car rolls backwards although state() has a forward speed (DirectionWatch).
  [[nodiscard]] bool rolls_back() const noexcept { return direction_.rolls_back(); }

  /// The state at `time` >= the last measurement's [s], commands in flight replayed for exactly the fractions
  /// they act.
  struct Prediction {
    model::State state;
    double acceleration = 0.0;  ///< net longitudinal acceleration then [m/s²]
    Disturbance disturbance;
  };
  [[nodiscard]] Prediction predict(double time, const CommandHistory& sent) const noexcept;
  /// Speed at `time` by the pedals alone [m/s]. Below PredictionModel::kSpeedFloor a car rolls on, while in
  /// the model its turned wheels brake it.
  [[nodiscard]] double rolling_speed(double time, const CommandHistory& sent) const noexcept;

 private:
  static constexpr double kMostLateral = 6.0;  ///< largest disturbance [m/s²]
  static constexpr double kMostYaw = 6.0;      ///< [rad/s²]

  void take_over(const model::Measurement& now, double dx, double dy, double dpsi) noexcept;
  struct Correction {
    ErrorCovariance::Vector by;
    double share;  ///< share of a position innovation that is taken over, also along the car
  };
  [[nodiscard]] Correction correction(double aside, double heading, double elapsed,
                                      bool is_after_gap) noexcept;
  void advance(Prediction& at, double from, double to, const CommandHistory& sent,
               ErrorCovariance* errors = nullptr) const noexcept;
  void advance_errors(ErrorCovariance& errors, const model::BodyMotion<double>& from,
                      const model::BodyMotion<double>& to, double steer, double asked, double dt,
                      const model::PredictionModel::Lags& lags) const noexcept;

  model::PredictionModel model_;
  ErrorCovariance errors_;
  double average_ = 0.0;  ///< average_over() [s]
  bool is_disturbed_ = false;
  bool minds_gap_ = false;
  bool is_started_ = false;
  double time_ = 0.0;
  double place_seen_ = 0.0;    ///< time of the last place that was measured together with a heading [s]
  double heading_seen_ = 0.0;  ///< time of the last heading [s]
  Prediction now_;             ///< at time_
  Surprise surprise_;
  DirectionWatch direction_;
};

/// Throttle that stops a car that rolls backwards with `speed` [m/s], > 0: the drive, for cars whose brake
/// pedal is the reverse gear then.
[[nodiscard]] double throttle_against_rolling_back(const model::VehicleParams& vehicle,
                                                   double speed) noexcept;

/// Estimates the grip of the tyres as a share of the assumed grip, by which grip predicts the next
/// measurement better (docs/racing.md, eq. 3 to 7). Two estimators see the same measurements and commands,
/// one with the assumed grip, one with a little less. Their innovations have the same noise, so that the
/// difference shows the effect of grip alone; least squares over the last kMemory of cornering finds the
/// share without bias by noise. The deviation is the larger of that by noise and that between bends, because
/// a model error lasts for a whole bend.
///
/// Errors of mass, side wind and steering gain appear as grip.
///
/// A third estimator sees the commands act a little later. Errors of heading over its difference say how much
/// another delay than configured explains (docs/limit.md, eq. 18). One thread; allocates nothing.
class GripEstimator {
 public:
  static constexpr double kLeast = 3.0;             ///< least lateral acceleration that shows grip [m/s²]
  static constexpr double kMemory = 10.0;           ///< time constant of forgetting, in time of cornering [s]
  static constexpr double kShortestBend = 1.0;      ///< shorter bends count together as one [s]
  static constexpr double kLongestBend = 4.0;       ///< longer bends count as several [s]
  static constexpr int kEnough = 3;                 ///< bends until the share is known
  static constexpr double kSure = 0.1;              ///< largest standard deviation of a known share
  static constexpr double kLow = 0.3, kHigh = 1.6;  ///< range of share()

  explicit GripEstimator(const model::PredictionModel& model) noexcept
      : assumed_{model}, less_{model}, late_{model} {}

  /// Restarts at the state of `from`, with the assumed car.
  void begin(const StateEstimator& from, const model::PredictionModel& assumed) noexcept;
  void see(const model::Measurement& now, const CommandHistory& sent) noexcept;

  [[nodiscard]] bool is_known() const noexcept { return bends_.count >= kEnough && deviation() <= kSure; }
  /// Share of the assumed grip; 1 until it is known.
  [[nodiscard]] double share() const noexcept;
  /// Whether share() differs from 1 by more than `least`, and significantly (5 %).
  [[nodiscard]] bool differs(double least) const noexcept;
  /// Standard deviation of share(), the larger of eq. 6 and 7; infinite before the first corner.
  [[nodiscard]] double deviation() const noexcept;
  /// Root mean square of the error of delay that explains the errors of heading [s]: jitter, and whatever
  /// else is not modelled. Infinite before the first corner.
  [[nodiscard]] double unsure_time() const noexcept;
  /// Mean time between measurements in corners [s].
  [[nodiscard]] double interval() const noexcept { return interval_; }

 private:
  static constexpr double kStep = 0.1;   ///< grip that the second estimator lacks, share
  static constexpr double kLate = 0.02;  ///< delay that the third estimator adds [s]

  GripEstimator(const StateEstimator& assumed, const StateEstimator& less,
                const StateEstimator& late) noexcept
      : assumed_{assumed}, less_{less}, late_{late} {}

  /// Sums of the unexpected part of the place, n, and of the grip's effect on it, h [m], times seconds.
  struct Sums {
    double hh = 0.0, hn = 0.0, nn = 0.0;

    void add(double h, double n, double left, double elapsed) noexcept;
    /// Variance of n without the part that the best share of h explains, per second.
    [[nodiscard]] double variance(double time) const noexcept;
  };

  /// Squares of what each bend adds to the sums of (7).
  struct Bends {
    double hnhn = 0.0, hnhh = 0.0, hhhh = 0.0;
    int count = 0;
  };
  void end_bend() noexcept;

  StateEstimator assumed_, less_, late_;
  double time_ = 0.0;      ///< remembered time of cornering [s]
  double interval_ = 0.0;  ///< interval() [s]
  Sums all_;
  Sums bend_;               ///< sums of the present bend
  double bend_time_ = 0.0;  ///< duration of the present bend [s]
  double side_ = 0.0;       ///< sign of the turn at the last measurement in a bend
  Bends bends_;
  /// Sums of squares over corners: error of heading, and its change by delay [rad/s].
  double off_ = 0.0, by_time_ = 0.0;
};

}  // namespace chicane::tracking
