// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace chicane::tracking {

/// Covariance of the error of an estimated car, and the gains of a Kalman filter that follow from it
/// (docs/controller.md, eq. 22 to 25). Lateral position, heading, lateral velocity and yaw rate are coupled:
/// an error of the heading moves the position by speed times time, and lateral velocity and yaw rate change
/// by the slopes of the tyres. Sensor noise and model error are estimated from the innovations. SI units,
/// left positive. Allocates nothing; one thread.
class ErrorCovariance {
 public:
  /// Index of an estimated quantity: offset to the left [m], heading [rad], lateral velocity [m/s], yaw rate
  /// [rad/s], and the disturbance's lateral [m/s²] and yaw acceleration [rad/s²].
  enum State : std::size_t { kAside, kHeading, kSlide, kYawRate, kLateral, kYaw, kStates };
  using Vector = std::array<double, kStates>;
  static constexpr double kMostShare = 0.8;  ///< largest gain for a measured quantity itself (eq. 22); chosen

  /// Derivatives of lateral velocity and yaw rate after a step by those before it.
  struct Slopes {
    double slide_by_slide, slide_by_yaw_rate, yaw_rate_by_slide, yaw_rate_by_yaw_rate;
  };

  ErrorCovariance() noexcept { reset(); }
  /// Starts a run: noise and model error are unknown.
  void reset() noexcept;
  /// Starts an estimate at a measurement. Noise and model error stay.
  void begin() noexcept;
  /// Estimates the accelerations that the model lacks; switched off, as at first, they count as noise.
  void estimate_disturbance(bool is_on) noexcept;
  /// Advances the covariance by a step of dt [s] at `speed` [m/s]; `fading`: share of the disturbance that
  /// remains after the step.
  void advance(double dt, double speed, const Slopes& slopes, double fading) noexcept;

  /// Measurement less its prediction: to the left of the car [m] and of the heading [rad]; NaN for what was
  /// not measured. `is_after_gap`: the previous measurement is too old for an estimate of the noise.
  struct Innovation {
    double aside, heading;
    bool is_after_gap;
  };
  /// Updates the covariance by a measurement. Returns the correction of the estimate.
  Vector correct(const Innovation& innovation) noexcept;

  /// Variance of the error of lateral velocity at a point `behind` [m] the centre of mass [m²/s²].
  [[nodiscard]] double slide_variance(double behind) const noexcept {
    const double variance =
        p_[kSlide][kSlide] - 2.0 * behind * p_[kSlide][kYawRate] + behind * behind * p_[kYawRate][kYawRate];
    return variance > 0.0 ? variance : 0.0;
  }
  /// Gain of the last lateral innovation for the lateral position; [0, kMostShare].
  [[nodiscard]] double place_share() const noexcept { return place_share_; }
  /// Estimated standard deviation of the measured position, to the side of the car [m].
  [[nodiscard]] double place_noise() const noexcept { return std::sqrt(aside_.noise()); }
  /// Estimated standard deviation of the measured heading [rad].
  [[nodiscard]] double heading_noise() const noexcept { return std::sqrt(heading_.noise()); }

 private:
  /// Noise of one measured quantity, and the error of the model in it.
  struct Channel {
    double square = 0.0;   ///< mean of the innovation times its rest after the correction [unit²]
    double product = 0.0;  ///< mean of the innovation times the previous one [unit²]
    double last = 0.0;     ///< previous innovation [unit]
    double spread = 1.0;   ///< mean of the squared innovation over its expected variance
    double model = 0.0;    ///< standard deviation of the acceleration that the model lacks [unit/s²]

    /// Variance of the noise [unit²].
    [[nodiscard]] double noise() const noexcept { return square > product ? square - product : 0.0; }
    void learn(double innovation, double rest, double expected, double least, double most) noexcept;
  };
  /// Updates the covariance by one measured quantity and adds the corrections to `correction`.
  void take(State state, double innovation, Channel& channel, bool is_after_gap, Vector& correction) noexcept;

  std::array<Vector, kStates> p_{};  ///< covariance, symmetric
  Channel aside_, heading_;
  double place_share_ = kMostShare;  ///< place_share()
  bool is_disturbed_ = false;        ///< estimate_disturbance()
};

}  // namespace chicane::tracking
