// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/tracking/command_history.hpp"
#include "chicane/tracking/state_estimator.hpp"

namespace chicane::tracking {

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
  /// Standard deviation of share(), the larger of eq. 4 and 5; infinite before there is any corner.
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

  /// Squares of what each bend adds to the sums of (3).
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
