// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "chicane/model/prediction.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/tracking/error_covariance.hpp"

/// Where the car is: its state from delayed measurements and the commands in flight, and the grip of its
/// tyres.

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
    double time = 0.0;  ///< time from which the command acts [s]
    model::Command command;
  };
  static constexpr std::size_t kCapacity = 128;  ///< commands; chosen: 128 · 20 ms = 2.6 s
  std::array<Entry, kCapacity> entries_{};       ///< ascending in time
  std::size_t count_ = 0;                        ///< used entries
};

/// Detects a car that rolls backwards by its displacement, because its speed is measured without a sign.
class DirectionWatch {
 public:
  static constexpr double kPath = 2.0;  ///< way over which the direction is judged [m]; chosen
  void reset() noexcept { *this = {}; }
  /// Adds a measurement.
  void see(const model::Measurement& now) noexcept;
  /// Whether the car moved against its heading over the last kPath. False for a car that stands or slides
  /// sideways.
  [[nodiscard]] bool rolls_back() const noexcept { return rolls_back_; }

 private:
  bool has_last_ = false;                  ///< whether there was a measurement
  double time_ = 0.0, x_ = 0.0, y_ = 0.0;  ///< last measurement [s, m]
  double path_ = 0.0;                      ///< way by the measured speed since the last judgement [m]
  double along_ = 0.0;                     ///< displacement along the heading since then [m]
  bool rolls_back_ = false;                ///< last judgement
};

/// Accelerations of the car beyond the model, estimated from recent measurements.
struct Disturbance {
  static constexpr double kTime = 0.5;  ///< time constant of decay without measurements [s]; chosen

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
  static constexpr double kLongestGap =
      1.0;  ///< longest prediction; a longer silence restarts the estimate [s]

  explicit StateEstimator(const model::PredictionModel& model) noexcept : model_{model} {}
  /// Forgets the estimate; the next measurement starts another one.
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
  /// Averages innovations over `time` [s] instead of by the estimated noise; 0, as at first: by the noise.
  void average_over(double time) noexcept { average_ = time; }
  /// Changes the model; the estimate stays.
  void set_model(const model::PredictionModel& model) noexcept { model_ = model; }
  [[nodiscard]] const model::PredictionModel& model() const noexcept { return model_; }

  /// Updates the estimate by a measurement; afterwards state() is the estimate at now.time. Values that are
  /// not finite are replaced by predicted ones.
  void correct(const model::Measurement& now, const CommandHistory& sent) noexcept;
  /// Estimated state at time().
  [[nodiscard]] const model::State& state() const noexcept { return now_.state; }
  /// Replaces the estimated state, for example by another estimator's.
  void set_state(const model::State& state) noexcept { now_.state = state; }
  [[nodiscard]] double time() const noexcept { return time_; }  ///< of state() [s]
  /// Whether a measurement has started the estimate.
  [[nodiscard]] bool is_started() const noexcept { return is_started_; }
  /// Estimated longitudinal acceleration by drive, brakes and drag [m/s²].
  [[nodiscard]] double acceleration() const noexcept { return now_.acceleration; }
  /// Innovation: last measurement less its prediction; NaN without one.
  struct Surprise {
    double aside = std::numeric_limits<double>::quiet_NaN();    ///< lateral, left positive [m]
    double heading = std::numeric_limits<double>::quiet_NaN();  ///< [rad]
  };
  [[nodiscard]] const Surprise& surprise() const noexcept { return surprise_; }
  [[nodiscard]] const ErrorCovariance& errors() const noexcept { return errors_; }
  [[nodiscard]] const Disturbance& disturbance() const noexcept { return now_.disturbance; }
  /// Whether the car rolls backwards although state() has a forward speed (DirectionWatch).
  [[nodiscard]] bool rolls_back() const noexcept { return direction_.rolls_back(); }

  /// Predicted state of the car.
  struct Prediction {
    model::State state;
    double acceleration = 0.0;  ///< net longitudinal acceleration then [m/s²]
    Disturbance disturbance;
  };
  /// Prediction for `time` >= the last measurement's [s]. Each command in flight acts for exactly its share
  /// of a step.
  [[nodiscard]] Prediction predict(double time, const CommandHistory& sent) const noexcept;
  /// Speed at `time` by the pedals alone [m/s], for speeds below PredictionModel::kSpeedFloor: there the
  /// model brakes a car with turned wheels, while a real one rolls on.
  [[nodiscard]] double rolling_speed(double time, const CommandHistory& sent) const noexcept;

 private:
  static constexpr double kMostLateral = 6.0;  ///< largest disturbance [m/s²]; chosen
  static constexpr double kMostYaw = 6.0;      ///< largest disturbance [rad/s²]; chosen

  /// Corrects the estimate by a measurement that lies (dx, dy) [m] in W and dpsi [rad] from its prediction.
  void take_over(const model::Measurement& now, double dx, double dy, double dpsi) noexcept;
  struct Correction {
    ErrorCovariance::Vector by;  ///< change of the estimate
    double share;                ///< gain of a position innovation for the position, also along the car
  };
  /// Correction by innovations to the left [m] and of the heading [rad], `elapsed` [s] after the previous
  /// measurement.
  [[nodiscard]] Correction correction(double aside, double heading, double elapsed,
                                      bool is_after_gap) noexcept;
  /// Moves a prediction, and the covariance unless it is null, between two times [s].
  void advance(Prediction& at, double from, double to, const CommandHistory& sent,
               ErrorCovariance* errors = nullptr) const noexcept;
  /// Advances the covariance over a step from one motion to another, by the model's slopes there.
  void advance_errors(ErrorCovariance& errors, const model::BodyMotion<double>& from,
                      const model::BodyMotion<double>& to, double steer, double asked, double dt,
                      const model::PredictionModel::Lags& lags) const noexcept;

  model::PredictionModel model_;
  ErrorCovariance errors_;
  double average_ = 0.0;       ///< average_over() [s]
  bool is_disturbed_ = false;  ///< estimate_disturbance()
  bool minds_gap_ = false;     ///< mind_helper_gap()
  bool is_started_ = false;    ///< is_started()
  double time_ = 0.0;          ///< time of the last measurement [s]
  double place_seen_ = 0.0;    ///< time of the last position that was measured together with a heading [s]
  double heading_seen_ = 0.0;  ///< time of the last measured heading [s]
  Prediction now_;             ///< estimate at time_
  Surprise surprise_;
  DirectionWatch direction_;
};

/// Throttle that stops a car that rolls backwards with `speed` [m/s], > 0: the drive for cars whose brake
/// pedal is then the reverse gear, the brakes for others.
[[nodiscard]] double throttle_against_rolling_back(const model::VehicleParams& vehicle,
                                                   double speed) noexcept;

/// Estimates the grip of the tyres as a share of the assumed grip: the share that predicts measurements best
/// (docs/racing.md, eq. 3 to 7). Two estimators get the same measurements and commands, one with the assumed
/// grip, one with a little less. Their innovations have the same noise, so that their difference shows the
/// effect of grip alone. Least squares over the last kMemory of cornering finds the share without bias by
/// noise. Its standard deviation is the larger of that by noise and that between bends, because a model error
/// lasts for a whole bend. Errors of mass, side wind and steering gain appear as grip.
///
/// A third estimator assumes that commands act a little later. The innovations of the heading, divided by the
/// difference that this makes, show the error of the configured delay (docs/limit.md, eq. 18). One thread;
/// allocates nothing.
class GripEstimator {
 public:
  // Chosen (docs/racing.md).
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
  /// Adds a measurement.
  void see(const model::Measurement& now, const CommandHistory& sent) noexcept;

  /// Whether enough bends agree on the share.
  [[nodiscard]] bool is_known() const noexcept { return bends_.count >= kEnough && deviation() <= kSure; }
  /// Share of the assumed grip; 1 until it is known.
  [[nodiscard]] double share() const noexcept;
  /// Whether share() differs from 1 by more than `least`, and significantly (5 %).
  [[nodiscard]] bool differs(double least) const noexcept;
  /// Standard deviation of share(), the larger of eq. 6 and 7; infinite before the first corner.
  [[nodiscard]] double deviation() const noexcept;
  /// Root mean square of the error of delay that explains the innovations of the heading [s]: jitter and all
  /// that the model lacks. Infinite before the first corner.
  [[nodiscard]] double unsure_time() const noexcept;
  /// Mean time between measurements in corners [s].
  [[nodiscard]] double interval() const noexcept { return interval_; }

 private:
  static constexpr double kStep = 0.1;   ///< share of the grip that the second estimator lacks; chosen
  static constexpr double kLate = 0.02;  ///< delay that the third estimator adds [s]; chosen

  GripEstimator(const StateEstimator& assumed, const StateEstimator& less,
                const StateEstimator& late) noexcept
      : assumed_{assumed}, less_{less}, late_{late} {}

  /// Sums of products of the lateral innovation n and the effect h of grip on it, times seconds [m² s].
  struct Sums {
    double hh = 0.0, hn = 0.0, nn = 0.0;

    /// Adds a measurement `elapsed` [s] after the previous one; `left`: share of the old sums that is kept.
    void add(double h, double n, double left, double elapsed) noexcept;
    /// Variance of n without the part that the best share of h explains [m²], from sums over `time` [s].
    [[nodiscard]] double variance(double time) const noexcept;
  };

  /// Sums over bends of the products of each bend's own sums (eq. 7).
  struct Bends {
    double hnhn = 0.0, hnhh = 0.0, hhhh = 0.0;
    int count = 0;  ///< bends so far
  };
  /// Adds the present bend to the sums over bends.
  void end_bend() noexcept;

  StateEstimator assumed_, less_, late_;  ///< with the assumed grip, with less grip, with later commands
  double time_ = 0.0;                     ///< remembered time of cornering [s]
  double interval_ = 0.0;                 ///< interval() [s]
  Sums all_;                              ///< sums over the remembered time
  Sums bend_;                             ///< sums of the present bend
  double bend_time_ = 0.0;                ///< duration of the present bend [s]
  double side_ = 0.0;  ///< lateral acceleration at the last measurement in a bend; its sign tells the side
  Bends bends_;
  /// Sums over corners: squared innovation of the heading [rad² s], and its squared change by delay [rad²/s].
  double off_ = 0.0, by_time_ = 0.0;
};

}  // namespace chicane::tracking
