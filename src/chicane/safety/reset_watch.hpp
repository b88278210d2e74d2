// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/model/state.hpp"

namespace chicane::safety {

/// Whether a car that is measured elsewhere than it can be was really put there, or is measured right again
/// (docs/safety.md, "A trial"). It has to answer: move as its pedal asks, along its heading, as far as its
/// speed says. A localiser that reports a constant place does not answer, and is not accepted. A measurement
/// that jumps to standstill asks for it by itself; any other has to have rested. No allocation; one thread.
class ResetWatch {
 public:
  static constexpr double kJump = 1.0;               ///< [m] between two measurements, beyond what was driven
  static constexpr double kStandingSpeed = 1.0;      ///< [m/s] of a car that was put elsewhere
  static constexpr double kWay = 0.5;                ///< [m] after which the answer counts
  static constexpr double kDisagreement = 0.1;       ///< [m] between displacement and integrated speed
  static constexpr double kDisagreementShare = 0.2;  ///< and of the way
  static constexpr double kLongest = 60.0;           ///< [s] after which a jump is forgotten

  void reset() noexcept { *this = {}; }
  /// Takes in a measurement as it came. `pedal`: acts now, [-1, 1].
  void see(const model::Measurement& now, double pedal) noexcept;

  /// The measurements have agreed with each other for kRest, of a car that stands, and not just where it did
  /// not answer.
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
  model::Measurement origin_;  ///< where the car seems to have been put
  bool has_last_ = false;
  model::Measurement rests_since_;
  model::Measurement silent_{.time = -kLongest};  ///< where the car did not answer
  bool has_jumped_ = false;
  bool is_waiting_ = false;
  bool has_answered_ = false;
  double driven_ = 0.0;  ///< way from there by the measured speed [m]
  double asked_ = 0.0;   ///< integral of the pedal over the last half second [s]
};

}  // namespace chicane::safety
