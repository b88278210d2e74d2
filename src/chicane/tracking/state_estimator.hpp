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

/// The commands this controller has sent, with the time from which each acts. Fixed memory; the oldest is
/// forgotten.
class CommandHistory {
 public:
  void clear() noexcept { count_ = 0; }
  /// `command` acts from `time` [s] on; later commands replace earlier ones that would act later.
  void add(double time, const model::Command& command) noexcept;
  /// The same times with other commands: what `change` makes of each.
  template <class Change>
  [[nodiscard]] CommandHistory changed(const Change& change) const noexcept {
    CommandHistory other = *this;
    for (Entry& entry : other.entries_) entry.command = change(entry.command);
    return other;
  }
  /// Each command acts `time` [s] later; negative: earlier.
  void delay(double time) noexcept {
    for (Entry& entry : entries_) entry.time += time;
  }
  /// The command acting at `time`; zero before the first.
  [[nodiscard]] model::Command at(double time) const noexcept;
  /// First change of command after `time`, or `limit` when there is none before it.
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

/// Whether a car rolls backwards: its speed is measured without a sign, so that only its displacement tells.
class DirectionWatch {
 public:
  static constexpr double kPath = 2.0;  ///< [m] after which it is known
  void reset() noexcept { *this = {}; }
  void see(const model::Measurement& now) noexcept;
  /// Over the last kPath the car has moved against its heading. False for a car that stands or slides across.
  [[nodiscard]] bool rolls_back() const noexcept { return rolls_back_; }

 private:
  bool has_last_ = false;
  double time_ = 0.0, x_ = 0.0, y_ = 0.0;  ///< of the measurement before
  double path_ = 0.0;                      ///< by the measured speed [m]
  double along_ = 0.0;                     ///< and what of it was along the heading [m]
  bool rolls_back_ = false;
};

/// What the car accelerates by beyond the model, as measurements have shown lately; less and less true later.
struct Disturbance {
  /// Time constant by which it fades where it is not measured anew [s].
  static constexpr double kTime = 0.5;

  double lateral = 0.0;  ///< of v_y [m/s²]
  double yaw = 0.0;      ///< of the yaw rate [rad/s²]

  /// Leaves what is true of it `dt` [s] later, to first order in dt.
  void fade(double dt) noexcept {
    const double left = kTime / (kTime + dt);
    lateral *= left;
    yaw *= left;
  }
};

/// Where the car is, and where it will be when the next command acts: the prediction model driven by the
/// commands that are really in flight, and by a disturbance where one is asked for, corrected by each
/// measurement. Yaw rate and sideslip, which telemetry does not hold, come from here.
class StateEstimator {
 public:
  explicit StateEstimator(const model::PredictionModel& model) noexcept : model_{model} {}
  void reset() noexcept {
    is_started_ = false;
    direction_.reset();
    errors_.reset();
  }
  /// Whether a disturbance is estimated from now on; off at first.
  void estimate_disturbance(bool is_on) noexcept {
    errors_.estimate_disturbance(is_on);
    is_disturbed_ = is_on;
    now_.disturbance = {};
  }
  /// Whether what the steer helper leaves out is counted from now on (model/actuator.hpp); off at first.
  void mind_helper_gap(bool is_on) noexcept { minds_gap_ = is_on; }
  /// Innovations are averaged over `time` [s] from now on, whatever the noise; 0: by the noise, as at first.
  void average_over(double time) noexcept { average_ = time; }
  /// Another model from now on; the estimate stays.
  void set_model(const model::PredictionModel& model) noexcept { model_ = model; }
  [[nodiscard]] const model::PredictionModel& model() const noexcept { return model_; }

  /// Takes in a measurement. Afterwards state() is the estimate at now.time; what of it is not finite is
  /// replaced by what the model expects.
  void correct(const model::Measurement& now, const CommandHistory& sent) noexcept;
  [[nodiscard]] const model::State& state() const noexcept { return now_.state; }
  /// Adds `by` to the estimate: what another model would have made of it.
  void move(const model::State& by) noexcept;
  [[nodiscard]] double time() const noexcept { return time_; }  ///< of state() [s]
  [[nodiscard]] bool is_started() const noexcept { return is_started_; }
  [[nodiscard]] double acceleration() const noexcept { return now_.acceleration; }
  /// The last measurement beside what was expected of it; NaN where nothing was.
  struct Surprise {
    double aside = std::numeric_limits<double>::quiet_NaN();    ///< [m] to the left of the expected place
    double heading = std::numeric_limits<double>::quiet_NaN();  ///< [rad]
  };
  [[nodiscard]] const Surprise& surprise() const noexcept { return surprise_; }
  [[nodiscard]] const ErrorCovariance& errors() const noexcept { return errors_; }
  [[nodiscard]] const Disturbance& disturbance() const noexcept { return now_.disturbance; }
  /// What state() has for a speed forward is one backwards (DirectionWatch).
  [[nodiscard]] bool rolls_back() const noexcept { return direction_.rolls_back(); }

  /// The state at `time` >= the last measurement's [s], commands in flight replayed for exactly the fractions
  /// they act.
  struct Prediction {
    model::State state;
    double acceleration = 0.0;  ///< net longitudinal acceleration then [m/s²]
    Disturbance disturbance;
  };
  [[nodiscard]] Prediction predict(double time, const CommandHistory& sent) const noexcept;
  /// Speed at `time` [m/s] by the pedals alone. A car slower than PredictionModel::kSpeedFloor rolls on where
  /// the model has it braked by its turned wheels.
  [[nodiscard]] double rolling_speed(double time, const CommandHistory& sent) const noexcept;

 private:
  static constexpr double kMostLateral = 6.0;  ///< largest disturbance [m/s²]
  static constexpr double kMostYaw = 6.0;      ///< [rad/s²]

  void take_over(const model::Measurement& now, double dx, double dy, double dpsi) noexcept;
  struct Correction {
    ErrorCovariance::Vector by;
    double share;  ///< taken over from an innovation of the place, also along the car
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
  double heading_seen_ = 0.0;  ///< and of the last heading
  Prediction now_;             ///< at time_
  Surprise surprise_;
  DirectionWatch direction_;
};

/// The throttle that brings a car to rest that rolls backwards with `speed` [m/s], > 0: where the brake pedal
/// is the reverse gear then, its drive has to.
[[nodiscard]] double throttle_against_rolling_back(const model::VehicleParams& vehicle,
                                                   double speed) noexcept;

/// How much grip the tyres have, over the assumed one, by which grip predicts the next measurement better
/// (docs/racing.md, eq. 3 to 7). Two estimators see the same measurements and commands, one with the
/// assumed grip, one with a little less. What each did not expect is noise and the wrong grip; the noise is
/// the same in both, so that their difference says what the grip does alone, and least squares over the last
/// kMemory of cornering finds the share, without the bias of noise. How sure it is, is the larger of what
/// noise explains and of what the bends disagree by: a model that lacks something is wrong for a whole bend.
///
/// Another mass, a side wind or steering that answers otherwise pass for grip.
///
/// A third estimator sees the commands act a little later. What the headings are off by, beside what that
/// makes of them, says how much another time than configured explains (docs/limit.md, eq. 18). One thread;
/// allocates nothing.
class GripEstimator {
 public:
  static constexpr double kLeast = 3.0;  ///< [m/s²] of lateral acceleration by tyres: less tells too little
  static constexpr double kMemory = 10.0;  ///< time constant of forgetting, of cornering [s]
  static constexpr double kShortestBend =
      1.0;  ///< cornering [s] that counts as one; shorter bends count together
  static constexpr double kLongestBend = 4.0;  ///< longer ones count as several
  static constexpr int kEnough = 3;            ///< bends until something is known
  static constexpr double kSure = 0.1;         ///< standard deviation of share() from which on it is known
  static constexpr double kLow = 0.3, kHigh = 1.6;  ///< range of share()

  explicit GripEstimator(const model::PredictionModel& model) noexcept
      : assumed_{model}, less_{model}, late_{model} {}

  /// Restarts where `from` is, with the assumed car.
  void begin(const StateEstimator& from, const model::PredictionModel& assumed) noexcept;
  void see(const model::Measurement& now, const CommandHistory& sent) noexcept;

  [[nodiscard]] bool is_known() const noexcept { return bends_.count >= kEnough && deviation() <= kSure; }
  /// Grip over the assumed one; 1 until it is known.
  [[nodiscard]] double share() const noexcept;
  /// Whether share() differs from one by more than `least`, and by more than noise does in one case of 20.
  [[nodiscard]] bool differs(double least) const noexcept;
  /// Standard deviation of share(), the larger of eq. 6 and 7; infinite before there is any corner.
  [[nodiscard]] double deviation() const noexcept;
  /// By how much a command may act otherwise than configured so that it explains the error of headings, root
  /// mean square [s]: jitter, and all else that is not known. Infinite before there is any corner.
  [[nodiscard]] double unsure_time() const noexcept;
  /// Mean time between measurements in corners [s].
  [[nodiscard]] double interval() const noexcept { return interval_; }

 private:
  static constexpr double kStep = 0.1;   ///< share of grip that the other estimator has less
  static constexpr double kLate = 0.02;  ///< by which commands act later for the third [s]

  GripEstimator(const StateEstimator& assumed, const StateEstimator& less,
                const StateEstimator& late) noexcept
      : assumed_{assumed}, less_{less}, late_{late} {}

  /// Sums of the unexpected part of the place, n, and of the grip's effect on it, h [m], times seconds.
  struct Sums {
    double hh = 0.0, hn = 0.0, nn = 0.0;

    void add(double h, double n, double left, double elapsed) noexcept;
    /// Of n about what the best share of h explains, per second.
    [[nodiscard]] double variance(double time) const noexcept;
  };

  /// Squares of what each bend adds to the sums of (7).
  struct Bends {
    double hnhn = 0.0, hnhh = 0.0, hhhh = 0.0;
    int count = 0;
  };
  void end_bend() noexcept;

  StateEstimator assumed_, less_, late_;
  double time_ = 0.0;      ///< of cornering, as far as it is remembered [s]
  double interval_ = 0.0;  ///< between measurements in corners, mean [s]
  Sums all_;
  Sums bend_;               ///< sums of the bend that goes on
  double bend_time_ = 0.0;  ///< [s]
  double side_ = 0.0;       ///< sign of the side that the last measurement in a bend turned to
  Bends bends_;
  /// Sums over corners of squares: what the heading was off by, and what it changes by with the time [rad/s].
  double off_ = 0.0, by_time_ = 0.0;
};

}  // namespace chicane::tracking
