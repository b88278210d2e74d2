// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace chicane::tracking {

/// Covariance of the error of an estimated car, and the gains of a Kalman filter that follow from it
/// (docs/controller.md, eq. 22 to 25). Place beside the car, heading, lateral velocity and yaw rate are
/// coupled: an error of the heading moves the place by speed times time, and lateral velocity and yaw rate
/// change by the slopes of the tyres. The noise of the sensors, and how wrong the model is, come from the
/// innovations. SI units, left positive. Allocates nothing; one thread.
class ErrorCovariance {
 public:
  enum State : std::size_t { kAside, kHeading, kSlide, kYawRate, kLateral, kYaw, kStates };
  using Vector = std::array<double, kStates>;
  static constexpr double kMostShare = 0.8;  ///< largest share of an innovation that is taken over

  /// What a step makes of a lateral velocity [m/s] and of a yaw rate [rad/s].
  struct Slopes {
    double slide_by_slide, slide_by_yaw_rate, yaw_rate_by_slide, yaw_rate_by_yaw_rate;
  };

  ErrorCovariance() noexcept { reset(); }
  /// A run begins: nothing is known of noise and model.
  void reset() noexcept;
  /// An estimate begins with a measurement; noise and model error stay.
  void begin() noexcept;
  /// Whether the accelerations that the model lacks are estimated; else they are noise. Off at first.
  void estimate_disturbance(bool is_on) noexcept;
  /// A step of dt [s] at `speed` [m/s]; `fading`: share of the disturbance that the step leaves.
  void advance(double dt, double speed, const Slopes& slopes, double fading) noexcept;

  /// A measurement less its expectation: beside the car [m] and of the heading [rad]; NaN where it was not
  /// measured. `is_after_gap`: the measurement before is too old to say how noisy this one is.
  struct Innovation {
    double aside, heading;
    bool is_after_gap;
  };
  /// Takes in a measurement. Returns the correction of the estimate.
  Vector correct(const Innovation& innovation) noexcept;

  /// Variance of the error of the lateral velocity of a point `behind` the centre of mass [m²/s²].
  [[nodiscard]] double slide_variance(double behind) const noexcept {
    const double variance =
        p_[kSlide][kSlide] - 2.0 * behind * p_[kSlide][kYawRate] + behind * behind * p_[kYawRate][kYawRate];
    return variance > 0.0 ? variance : 0.0;
  }
  /// Share of the last innovation of the place that was taken over; [0, kMostShare].
  [[nodiscard]] double place_share() const noexcept { return place_share_; }
  /// Estimated deviation of a sensor's noise: of the place beside the car [m], of the heading [rad].
  [[nodiscard]] double place_noise() const noexcept { return std::sqrt(aside_.noise()); }
  [[nodiscard]] double heading_noise() const noexcept { return std::sqrt(heading_.noise()); }

 private:
  /// One measured quantity: its noise, and how wrong the model is in it.
  struct Channel {
    double square = 0.0;   ///< mean of innovation times what was left of it
    double product = 0.0;  ///< mean of innovation times the one before
    double last = 0.0;
    double spread = 1.0;  ///< mean of innovation² over its expected variance
    double model = 0.0;   ///< deviation of the acceleration that the model lacks [unit/s²]

    [[nodiscard]] double noise() const noexcept { return square > product ? square - product : 0.0; }
    void learn(double innovation, double left, double expected, double least, double most) noexcept;
  };
  void take(State state, double innovation, Channel& channel, bool is_after_gap, Vector& by) noexcept;

  std::array<Vector, kStates> p_{};
  Channel aside_, heading_;
  double place_share_ = kMostShare;
  bool is_disturbed_ = false;
};

}  // namespace chicane::tracking
