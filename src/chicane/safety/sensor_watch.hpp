// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "chicane/base/vec2.hpp"
#include "chicane/model/state.hpp"

namespace chicane::safety {

/// Length of a car in full size, about the mean of those that ship [m].
inline constexpr double kFullSize = 4.5;
/// Time by which a command may act later than configured [s]: docs/guard.md, "Late commands".
inline constexpr double kLateCommand = 0.06;

/// Which signals cannot be true.
struct SensorDoubts {
  bool late = false;     ///< whole measurements are of earlier moments
  bool is_old = false;   ///< this one is
  bool place = false;    ///< it is not where speed and heading have led
  bool heading = false;  ///< it has turned otherwise than the wheels were turned
  bool speed = false;    ///< it has changed by more than the pedal does
};

/// Tells wrong signals from noise: place, heading and speed describe the same motion, each innovation and
/// their sum over up to 10 s (docs/guard.md, eq. 9 to 11). The limits follow the noise that was
/// seen before. They hold for a car that was measured calmly for kCalmTime; a car that slides or spins is
/// not, and nothing is doubted by them there. A doubt ends when the signal has agreed for kAgreeing with
/// where the car must be; never because it lasts. No allocation; one thread.
class SensorWatch {
 public:
  // Origins (chosen: by trial, see Guard):
  // - Chosen, docs/guard.md ("Signals that disagree"): kCalmTime, kAgreeing.
  static constexpr double kCalmTime = 2.0;  ///< [s]
  static constexpr double kAgreeing = 1.0;  ///< [s]

  /// `length`: of the car [m]; `wheelbase` [m].
  SensorWatch(double length, double wheelbase) noexcept;
  /// Forgets the samples. `late` stays until a start shows that measurements are current, unless it is
  /// forgotten, too.
  void reset(bool forgets_lateness = false) noexcept;

  /// The doubts in a finite measurement; `expected`: the car by the estimate at now.time.
  const SensorDoubts& see(const model::Measurement& now, const model::State& expected) noexcept;
  /// What was doubted came from a sensor that was frozen, and is not any more. Its age is another thing.
  void forget_doubts() noexcept { doubts_.place = doubts_.heading = doubts_.speed = false; }
  /// The last measurements agreed with each other, or one of them is in doubt: limits hold.
  [[nodiscard]] bool is_sure() const noexcept { return calm_ > kCalmTime; }
  /// Of the last see().
  [[nodiscard]] const SensorDoubts& doubts() const noexcept { return doubts_; }
  /// Place of the car by the signals that are not in doubt, while the measured place is [m].
  [[nodiscard]] const Vec2& place() const noexcept { return counted_place_; }

 private:
  /// One moment of the last seconds.
  struct Sample {
    double time = 0.0;
    Vec2 place{};                      ///< measured [m]
    double driven = 0.0;               ///< length of the way, along its bends [m]
    Vec2 way{};                        ///< way w by speed and heading (eq. 9) [m]
    Vec2 slip{};                       ///< part of the way by the estimated slip, w_β (eq. 11) [m]
    double turned = 0.0, asked = 0.0;  ///< turn of the heading, unwrapped, and by the wheels' angle [rad]
    model::State estimated;            ///< estimate at the time of the measurement
  };
  static constexpr std::size_t kSamples = 256;
  static constexpr double kSpacing = 0.0395;  ///< [s] at least: the samples reach 10 s back
  /// Noise of a signal: the mean square of its innovations.
  struct Noise {
    double square = 0.0;
    int count = 0;
    void learn(double innovation) noexcept;
    [[nodiscard]] double deviation() const noexcept;
  };
  /// Of one measurement against what is expected.
  struct Innovation {
    double place = 0.0, heading = 0.0, speed = 0.0;
  };

  [[nodiscard]] bool has_doubts() const noexcept {
    return doubts_.late || doubts_.place || doubts_.heading || doubts_.speed;
  }
  [[nodiscard]] Innovation limits() const noexcept;
  [[nodiscard]] const Sample& back(std::size_t count) const noexcept;
  void count_on(double elapsed, const model::Measurement& now, const model::State& expected) noexcept;
  [[nodiscard]] bool place_confirms_speed(double elapsed, const model::Measurement& now,
                                          const model::State& expected) const noexcept;
  void add_sample(const model::Measurement& now, const model::State& expected) noexcept;
  void learn(const Innovation& seen, const Innovation& most, double elapsed) noexcept;
  void judge_age(const model::Measurement& now, const model::State& expected, const Innovation& seen,
                 const Innovation& most, double elapsed) noexcept;
  void try_start(const model::Measurement& now, const model::State& expected, double elapsed) noexcept;
  void begin_doubts(const Innovation& seen, const Innovation& most) noexcept;
  void judge_sums(const model::Measurement& now) noexcept;
  [[nodiscard]] bool is_earlier(const model::Measurement& now, const Innovation& most) const noexcept;
  void end_doubts(const Innovation& seen, const Innovation& most, double elapsed, double turned) noexcept;

  double size_;       ///< of the car over one in full size
  double wheelbase_;  ///< [m]
  SensorDoubts doubts_;
  std::array<Sample, kSamples> samples_{};
  std::size_t count_ = 0;
  bool has_last_ = false;
  model::Measurement last_;
  double time_ = 0.0;                  ///< of the last call [s]
  double driven_ = 0.0;                ///< as in Sample [m]
  Vec2 way_{};                         ///< as in Sample [m]
  double slip_ = 0.0;                  ///< estimated slip of the last call [rad]
  Vec2 slip_way_{};                    ///< Sample::slip [m]
  double turned_ = 0.0, asked_ = 0.0;  ///< as in Sample [rad]
  double asked_rate_ = 0.0;            ///< rate of turning by the wheels' angle [rad/s]
  double estimated_speed_ = 0.0;       ///< estimated speed after the last call [m/s]
  double calm_ = 0.0;                  ///< time for which the car was measured calmly [s]
  double clean_from_ = -1e9;           ///< time of the last doubt [s]
  /// Times for which signals in doubt have agreed with what is expected [s].
  double place_agrees_ = 0.0, heading_agrees_ = 0.0, speed_agrees_ = 0.0;
  double late_agrees_ = 0.0;     ///< time for which measurements have been current [s]
  bool is_tried_ = false;        ///< whether the car answers late shows as it starts
  double asked_speed_ = 0.0;     ///< by the pedal since then [m/s]
  double lag_ = 0.0;             ///< [s]
  double retry_ = 0.0;           ///< from when on the car may start again [s]
  double agreed_heading_ = 0.0;  ///< what the heading differs by since it agrees [rad]
  double moved_ = 0.0;           ///< of the last step: place against speed and heading [m]
  double longer_ = 0.0;          ///< of the last step: displacement less what the speed says [m]
  bool has_jumped_ = false;      ///< a place in doubt: at once, not by a drift
  Vec2 counted_place_{};         ///< place() [m]
  double drift_ = 0.0;           ///< of the expected place, while it is not measured [m]
  double unseen_ = 0.0;          ///< for how long something has not been measured [s]
  Noise place_, heading_, speed_, length_;
  std::array<Noise, 3> sums_;
};

}  // namespace chicane::safety
