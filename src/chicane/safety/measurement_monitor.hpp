// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "chicane/model/state.hpp"
#include "chicane/safety/sensor_watch.hpp"

namespace chicane::safety {

/// What is wrong with a measurement.
struct Findings {
  bool late = false;            ///< it is of an earlier moment
  bool unmeasured = false;      ///< position, yaw, speed or time is not a number, or time ran backwards
  bool frozen = false;          ///< it repeats although the car moves, or what of it is not in doubt does
  bool speed_mismatch = false;  ///< its speed contradicts its displacement, or what the car can do
  bool heading_jump = false;    ///< its yaw is not where the car can have turned to
  bool position_jump = false;   ///< its place is not where the car can have moved to

  /// Nothing of it says where the car is now.
  [[nodiscard]] bool is_blind() const noexcept { return late || unmeasured || frozen; }
  [[nodiscard]] bool operator==(const Findings&) const = default;
};

/// Checks whether measurements are plausible (docs/guard.md, eq. 7 and 8). What is not plausible
/// is handed on as not measured (NaN), the rest of the measurement stays: a car that knows two of place, yaw
/// and speed can count on. A finding ends when the sensor agrees again with what is expected, that of a place
/// when it jumps back, too; it is never accepted because it lasts. No allocation; one thread.
class MeasurementMonitor {
 public:
  // Origins (chosen: by trial, see Guard):
  // - Derived: kJump (StateEstimator restarts there), kAcceleration (above indy's grip of 28 m/s² at 80
  //   m/s), kYawAcceleration (both axles of udacity against each other), kSamples and kSampleSpacing (the
  //   second of eq. 8).
  // - Chosen, docs/guard.md: kKnownDrift, kBlindDrift, kSpeedJump, kHeadingJump (eq. 7), kUnmoved, kMoving
  //   ("Frozen").
  static constexpr double kJump = 3.0;          ///< [m] from where the car is expected
  static constexpr double kKnownDrift = 0.012;  ///< of the distance driven since, with yaw and speed measured
  static constexpr double kBlindDrift = 0.15;   ///< and without
  static constexpr double kSpeedJump = 3.0;     ///< [m/s] from what is expected
  static constexpr double kAcceleration = 40.0;     ///< [m/s²] that no car here exceeds
  static constexpr double kHeadingJump = 0.35;      ///< [rad]
  static constexpr double kYawAcceleration = 12.0;  ///< [rad/s²] by which a turn may be unexpected
  static constexpr double kUnmoved = 0.3;           ///< [m] driven by its speed, and not by its place
  static constexpr double kMoving = 3.0;            ///< [m/s] a speed that shows that its sensor works

  /// `length`: of the car [m]; `wheelbase` [m].
  MeasurementMonitor(double length, double wheelbase) noexcept : watch_{length, wheelbase} {}
  /// Forgets what was measured; lateness as SensorWatch::reset() does.
  void reset(bool forgets_lateness = false) noexcept;

  /// `now`, with NaN where it is not plausible; `expected` at now.time, null when nothing is known yet. Valid
  /// until the next call.
  [[nodiscard]] const model::Measurement& check(const model::Measurement& now,
                                                const model::State* expected) noexcept;
  /// A car that was measured calmly drives on as it did: SensorWatch::is_sure().
  [[nodiscard]] bool is_sure() const noexcept { return watch_.is_sure(); }
  /// Error beyond kJump that the expected place may have after a way without measurements [m].
  [[nodiscard]] double place_drift() const noexcept { return place_drift_; }
  /// Of the last check().
  [[nodiscard]] const Findings& findings() const noexcept { return findings_; }

 private:
  explicit MeasurementMonitor(const SensorWatch& watch) noexcept : watch_{watch} {}
  /// Displacement and speed over the last second: what was measured at its beginning.
  struct Sample {
    double time = 0.0;    ///< [s]
    Vec2 place{};         ///< [m]
    double driven = 0.0;  ///< integral of the measured speed [m]
    Vec2 way{};           ///< integral of the measured speed along the measured heading [m]
  };
  /// Some of what a measurement holds.
  struct Signals {
    bool place = false, heading = false, speed = false;
    [[nodiscard]] bool any() const noexcept { return place || heading || speed; }
  };
  static constexpr int kSamples = 16;
  static constexpr double kSampleSpacing = 0.06;  ///< [s]

  void judge(const model::Measurement& now, const model::State& expected, double elapsed,
             bool was_frozen) noexcept;
  void count_drift(bool is_blind, double elapsed, double speed) noexcept;
  [[nodiscard]] static model::Measurement without(model::Measurement now, const Signals& missing) noexcept;
  [[nodiscard]] bool jumps(const model::Measurement& now, double elapsed) const noexcept;
  [[nodiscard]] bool is_frozen(const model::Measurement& now, double elapsed) noexcept;
  [[nodiscard]] bool is_stuck(const model::Measurement& now, const model::State& expected) noexcept;
  [[nodiscard]] bool contradicts_displacement(const model::Measurement& now, double elapsed) noexcept;

  SensorWatch watch_;
  model::Measurement checked_;
  Findings findings_;
  Findings own_;             ///< of them those of eq. 7 and 8
  model::Measurement last_;  ///< as it came
  bool has_last_ = false;
  Signals stuck_;             ///< signals that repeat, of a sensor that is stuck
  double thawed_ = 0.0;       ///< last time at which nothing was frozen [s]
  double same_since_ = 0.0;   ///< [s]
  double place_drift_ = 0.0;  ///< place_drift() [m]
  double other_drift_ = 0.0;  ///< and the expected speed [m/s]
  std::array<Sample, kSamples> samples_{};
  int sample_count_ = 0;
  double driven_ = 0.0;  ///< as in Sample [m]
  Vec2 way_{};           ///< as in Sample [m]
};

/// Whether a car that is measured elsewhere than it can be was really put there, or is measured right again
/// (docs/safety.md, "A trial"). It has to answer: move as its pedal asks, along its heading, as far as its
/// speed says. A localiser that reports a constant place does not answer, and is not accepted. A measurement
/// that jumps to standstill asks for it by itself; any other has to have rested. No allocation; one thread.
class ResetWatch {
 public:
  // Origins (chosen: by trial, see Guard):
  // - Chosen, docs/safety.md ("A trial"): kJump, kStandingSpeed, kWay, kLongest, kRest.
  // - Chosen, for what their lines say: kDisagreement, kDisagreementShare, kRestWay, kRestTurn.
  static constexpr double kJump = 1.0;               ///< [m] between two measurements, beyond what was driven
  static constexpr double kStandingSpeed = 1.0;      ///< [m/s] of a car that was put elsewhere
  static constexpr double kWay = 0.5;                ///< [m] after which the answer counts
  static constexpr double kDisagreement = 0.1;       ///< [m] between displacement and integrated speed
  static constexpr double kDisagreementShare = 0.2;  ///< and of the way
  static constexpr double kLongest = 60.0;           ///< [s] after which a jump is forgotten

  void reset() noexcept { *this = {}; }
  /// Takes in a measurement as it came. `pedal`: acts now, [-1, 1].
  void see(const model::Measurement& now, double pedal) noexcept;

  /// The measurements of a car that stands have agreed with each other for kRest. Not where the place just
  /// stayed the same while the car was to answer.
  [[nodiscard]] bool rests() const noexcept;
  static constexpr double kRest = 1.0;       ///< [s]
  static constexpr double kRestWay = 1.0;    ///< [m] by which a place may differ meanwhile
  static constexpr double kRestTurn = 0.05;  ///< [rad] and a heading
  /// The car is to answer where it is measured now.
  void ask() noexcept;
  /// It did not.
  void give_up() noexcept;
  /// The place of the last see() has moved farther than the car can.
  [[nodiscard]] bool has_jumped() const noexcept { return has_jumped_; }

  /// The car is measured elsewhere, standing, and has not answered yet.
  [[nodiscard]] bool is_waiting() const noexcept { return is_waiting_; }
  /// It has answered in the last call of see().
  [[nodiscard]] bool has_answered() const noexcept { return has_answered_; }

 private:
  [[nodiscard]] bool jumps(const model::Measurement& now) const noexcept;

  model::Measurement last_;
  model::Measurement origin_;    ///< where the car seems to have been put
  model::Measurement asked_at_;  ///< where it was asked to answer
  bool has_last_ = false;
  model::Measurement rests_since_;
  model::Measurement silent_{.time = -kLongest};  ///< where it was, if it did not
  bool has_jumped_ = false;
  bool is_waiting_ = false;
  bool has_answered_ = false;
  double driven_ = 0.0;  ///< way from there by the measured speed [m]
  double asked_ = 0.0;   ///< integral of the pedal over the last half second [s]
};

}  // namespace chicane::safety
