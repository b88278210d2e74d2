// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <string>

#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::run {

/// Options of an external car's clock.
/// Source of the run's time.
struct PlantClockOptions {
  bool is_estimated = false;  ///< true: ratio to the wall's time, or lock step, as the measurements show
  bool is_measured = false;   ///< true: Measurement::time, the simulator's own
  double lock_step = 0.0;     ///< time that the simulator advances with each answer [s]; 0: by its own clock
};

/// Time of the run of a car that another program simulates (docs/protocol.md, "Time"). A displacement over
/// its speed is the time that the simulator has advanced by. Over the last measurements of a driving car it
/// shows whether the simulator runs at a ratio of the wall's time, or in lock step: by the same time with
/// each answer. Noise and delays of a busy machine change neither.
///
/// A simulator that sends its own time needs none of that.
///
/// A speed in another unit looks like another clock, but for the acceleration that a pedal gives: no ratio is
/// taken up that contradicts it. No allocation but in news(); one thread.
class PlantClock {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr double kSlowest = 0.02, kFastest = 20.0;  ///< ratios to the wall's time that are found
  static constexpr double kLeastChange = 1.15;               ///< least factor between two different ratios
  static constexpr double kPedalError = 1.5;  ///< most factor between modelled and real effect of a pedal

  PlantClock(const PlantClockOptions& options, const model::VehicleParams& vehicle, Clock::time_point start);

  /// Resets for another car, with an unknown clock. The run's time continues.
  void begin();
  /// Leaves out the time until the next measurement, because a person drove or nothing came.
  void pause() { has_last_ &= options_.is_measured; }
  /// Takes a message that came at `received`, with `measured` (null: nothing usable), while `acting` acted on
  /// the car. True: the clock has changed, and results by the earlier time are void.
  bool advance(Clock::time_point received, const model::Measurement* measured, const model::Command& acting);

  /// Time of the run [s] at a moment of the wall's clock.
  [[nodiscard]] double at(Clock::time_point wall) const;
  /// Run time in which a command acts that the wall's clock expects after `delay` [s].
  [[nodiscard]] double delay(double delay) const { return step_ > 0.0 ? step_ : ratio_ * delay; }
  [[nodiscard]] double ratio() const { return ratio_; }     ///< run time over wall time
  [[nodiscard]] double lock_step() const { return step_; }  ///< [s]; 0: by its own clock
  /// Whether enough was measured since the last change to report it: lock step looks like a ratio at first.
  [[nodiscard]] bool is_settled() const { return options_.is_measured || count_ >= kLegs / 2; }
  /// Sentence for people on how time is counted.
  [[nodiscard]] std::string news() const;

 private:
  /// Stretch of driving, of at least one step between measurements.
  struct Leg {
    double wall = 0.0;   ///< duration by the wall's clock [s]
    double plant = 0.0;  ///< duration by displacement over speed [s]
    double way = 0.0;    ///< [m]
    int steps = 0;
    bool is_from_rest = false;  ///< the car stood when the leg began
  };
  static constexpr std::size_t kLegs = 12;
  /// Sums of legs.
  struct Fit {
    double value = 0.0;            ///< ratio of the sums, over legs near the median
    double near = 0.0, all = 0.0;  ///< plant's time: legs near the median, all legs [s]
    double all_counted = 0.0;      ///< time that all legs are compared with [s]
    double deviation = 0.0;        ///< root mean square of the running sums' error [s]
  };

  void forget();
  [[nodiscard]] bool follow(const model::Measurement* measured);
  [[nodiscard]] Leg step_of(double wall, const model::Measurement& now, const model::Command& acting);
  [[nodiscard]] bool add(const Leg& step);
  [[nodiscard]] bool take_up();
  template <class Base>
  [[nodiscard]] Fit fit(const Base& base) const;
  [[nodiscard]] double time_of(double wall, const Leg& step);

  PlantClockOptions options_;
  model::VehicleParams vehicle_;
  double size_;  ///< size of the car over full size
  Clock::time_point wall_;
  double time_ = 0.0;  ///< run time at wall_ [s]
  double ratio_ = 1.0;
  double step_;
  bool has_last_ = false;
  bool is_speed_known_ = false;  ///< the speed has agreed with the clock, or a pedal with the speed
  model::Measurement last_;
  Leg leg_;
  double gap_ = 0.0;  ///< wall time before the message with which leg_ begins [s]
  std::array<Leg, kLegs> legs_{};
  std::size_t count_ = 0;
  double sampled_ = 0.0;               ///< time counted in addition, for the age of states [s]
  int unusable_ = 0;                   ///< messages since the last measurement
  double ahead_ = 0.0;                 ///< run time minus the simulator's own time [s]
  double asked_ = 0.0, gained_ = 0.0;  ///< speed that the pedal should have given lately, and has [m/s]
};

}  // namespace chicane::run
