// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/controller/cubic_mpc.hpp"
#include "chicane/model/measurement.hpp"
#include "chicane/model/state.hpp"

namespace chicane::controller {

/// The state of the car by the described model.
struct Motion {
  model::Pose pose;
  double speed = 0.0;  ///< along the yaw [m/s]
};

/// x and y alone move on (docs/problem.md, equation 14).
[[nodiscard]] Motion roll_position(const Motion& from, double latency) noexcept;

/// One Euler step of the kinematic model over the latency (equation 15): ψ += v δ L / L_f, v += a L, with
/// `acting` as δ and, throttle taken for acceleration in m/s², as a.
[[nodiscard]] Motion roll_kinematic(const Motion& from, const model::Command& acting, double latency,
                                    double kinematic_length) noexcept;

/// The form that goes with the measured latency (equation 16): ψ += v tan δ L / L_f + a tan δ L² / (2 L_f).
/// `has_term`: false leaves out the last one, of the acceleration.
[[nodiscard]] Motion roll_accelerating(const Motion& from, const model::Command& acting, double latency,
                                       double kinematic_length, bool has_term = true) noexcept;

/// Chooses among them, and keeps the measured latency. Latency lies in [0, 0.5] s whatever is measured.
class RollForward {
 public:
  /// `speed_unit`: what is taken for 1 m/s on the way; `has_term`: equation 16 with its last term.
  RollForward(LatencyHandling handling, double latency, double kinematic_length, double speed_unit = 1.0,
              bool has_term = true) noexcept
      : handling_{handling},
        first_latency_{latency},
        latency_{latency},
        kinematic_length_{kinematic_length},
        speed_unit_{speed_unit},
        has_term_{has_term} {}

  /// The measured motion at the time the command acts, by the described means. Pre: finite pose, speed and
  /// commands.
  [[nodiscard]] Motion predict(const model::Measurement& now) noexcept;
  /// What the last predict() compensated [s]; 0 when nothing is rolled forward.
  [[nodiscard]] double compensated() const noexcept;
  void reset() noexcept { latency_ = first_latency_; }
  /// Other settings; a measured latency stays measured.
  void configure(LatencyHandling handling, double latency, double kinematic_length, double speed_unit = 1.0,
                 bool has_term = true) noexcept {
    const bool is_told_anew = handling != handling_ || latency != first_latency_;
    if (is_told_anew) latency_ = latency;
    handling_ = handling;
    first_latency_ = latency;
    kinematic_length_ = kinematic_length;
    speed_unit_ = speed_unit;
    has_term_ = has_term;
  }

 private:
  Motion roll(const model::Measurement& now, const Motion& seen) noexcept;

  LatencyHandling handling_;
  double first_latency_;
  double latency_;
  double kinematic_length_;
  double speed_unit_;
  bool has_term_;
};

}  // namespace chicane::controller
