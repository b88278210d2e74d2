// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>

#include "chicane/base/math.hpp"
#include "chicane/model/measurement.hpp"

namespace chicane::safety {

/// Checks whether measurements are plausible: finds a sensor that is frozen while the car moves, and one that
/// jumps to where no car can go (docs/faults.md, eq. 1 and 2). What is not plausible is handed on as not
/// measured (NaN). A jump back ends the suspicion; so does time: after kPatience the new position is more
/// likely than a sensor with so steady an error. No allocation; one thread.
class MeasurementMonitor {
 public:
  static constexpr double kPatience = 1.5;       ///< [s]
  static constexpr double kLongestStep = 0.5;    ///< [s] between measurements that say anything of each other
  static constexpr double kJump = 3.0;           ///< [m] beside where speed and heading lead
  static constexpr double kSpeedJump = 3.0;      ///< [m/s] beside what any braking explains
  static constexpr double kAcceleration = 40.0;  ///< [m/s²] that no car here exceeds, in any direction
  static constexpr double kUnmoved = 0.3;  ///< [m] that a car has driven by its speed, and not by its place

  void reset() noexcept { *this = {}; }

  /// `now`, with position, heading and speed NaN where they are not plausible. Valid until the next call.
  [[nodiscard]] const model::Measurement& check(const model::Measurement& now) noexcept {
    checked_ = now;
    if (!std::isfinite(now.time + now.x + now.y + now.psi + now.speed)) return checked_;
    const double elapsed = now.time - last_time_;
    const bool is_next = has_last_ && elapsed > 0.0 && elapsed < kLongestStep;
    const bool is_same =
        is_next && now.x == last_x_ && now.y == last_y_ && now.psi == last_psi_ && now.speed == last_speed_;
    if (!is_same) same_since_ = now.time;
    const bool is_frozen = now.speed * (now.time - same_since_) > kUnmoved;
    if (is_next) {
      const double reach = last_speed_ * elapsed;
      const double aside =
          hypot(now.x - last_x_ - reach * cos(last_psi_), now.y - last_y_ - reach * sin(last_psi_));
      place_.note(aside > kJump + kAcceleration * elapsed * elapsed && !was_frozen_, now.time);
      speed_.note(std::fabs(now.speed - last_speed_) > kSpeedJump + kAcceleration * elapsed && !was_frozen_,
                  now.time);
    } else {
      place_ = speed_ = Suspicion{};
    }
    was_frozen_ = is_frozen;
    has_last_ = true;
    last_time_ = now.time;
    last_x_ = now.x;
    last_y_ = now.y;
    last_psi_ = now.psi;
    last_speed_ = now.speed;
    if (is_frozen || place_.is_on || speed_.is_on)
      checked_.x = checked_.y = checked_.psi = checked_.speed = std::numeric_limits<double>::quiet_NaN();
    return checked_;
  }

 private:
  struct Suspicion {
    bool is_on = false;
    double since = 0.0;  ///< [s]
    void note(bool has_jumped, double time) noexcept {
      if (is_on && time - since > kPatience) is_on = false;
      if (!has_jumped) return;
      is_on = !is_on;
      since = time;
    }
  };

  model::Measurement checked_;
  Suspicion place_, speed_;
  bool has_last_ = false;
  bool was_frozen_ = false;
  double same_since_ = 0.0;  ///< [s]
  double last_time_ = 0.0, last_x_ = 0.0, last_y_ = 0.0, last_psi_ = 0.0, last_speed_ = 0.0;
};

}  // namespace chicane::safety
