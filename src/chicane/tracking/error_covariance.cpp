// SPDX-License-Identifier: MIT
// Covariance of the estimated car: prediction by the model's slopes, update by one measured quantity after
// the other, and sensor noise and model error from the innovations.
#include "chicane/tracking/error_covariance.hpp"

#include <algorithm>

#include "chicane/base/math.hpp"

namespace chicane::tracking {
namespace {

// Constants of eq. 22 to 24; chosen.
constexpr double kForgetting = 0.03;  // weight of the newest innovation in means
// Range of the standard deviation of the acceleration that the model lacks.
constexpr double kLeastLateral = 0.25, kMostLateral = 4.0;  // [m/s²]
constexpr double kLeastYaw = 0.125, kMostYaw = 2.0;         // [rad/s²]
constexpr double kErrorTime = 0.3;     // [s] duration of such an acceleration where it counts as noise
constexpr double kAdapting = 0.1;      // change of the log of that deviation by one product of innovations
constexpr double kLowSpread = 0.5;     // Channel::spread below which the deviation always falls
constexpr double kSpreadGain = 2.0;    // limit of its rise for each unit of spread above that
constexpr double kSurprise = 4.0;      // standard deviations of an innovation that show a wrong model at once
constexpr double kMostSurprise = 4.0;  // largest factor of the deviation by one innovation
// Standard deviations of a new estimate: the car may have any lateral velocity at first.
constexpr ErrorCovariance::Vector kFirst{0.1, 0.02, 2.0, 0.5, 0.0, 0.0};

}  // namespace

void ErrorCovariance::reset() noexcept {
  aside_ = {.model = kMostLateral};
  heading_ = {.model = kMostYaw};
  begin();
}

void ErrorCovariance::begin() noexcept {
  p_ = {};
  for (std::size_t i = 0; i < kStates; ++i) p_[i][i] = kFirst[i] * kFirst[i];
  aside_.last = heading_.last = 0.0;
  place_share_ = kMostShare;
}

void ErrorCovariance::estimate_disturbance(bool is_on) noexcept {
  is_disturbed_ = is_on;
  for (std::size_t i = 0; i < kStates; ++i)
    p_[i][kLateral] = p_[i][kYaw] = p_[kLateral][i] = p_[kYaw][i] = 0.0;
}

void ErrorCovariance::advance(double dt, double speed, const Slopes& slopes, double fading) noexcept {
  const auto step = [&](const Vector& x) noexcept {
    return Vector{
        x[kAside] + dt * (speed * x[kHeading] + x[kSlide]),
        x[kHeading] + dt * x[kYawRate],
        slopes.slide_by_slide * x[kSlide] + slopes.slide_by_yaw_rate * x[kYawRate] + dt * x[kLateral],
        slopes.yaw_rate_by_slide * x[kSlide] + slopes.yaw_rate_by_yaw_rate * x[kYawRate] + dt * x[kYaw],
        fading * x[kLateral],
        fading * x[kYaw]};
  };
  std::array<Vector, kStates> half;  // P Fᵀ, transposed: P is symmetric
  for (std::size_t i = 0; i < kStates; ++i) half[i] = step(p_[i]);
  for (std::size_t j = 0; j < kStates; ++j) {
    Vector column;
    for (std::size_t i = 0; i < kStates; ++i) column[i] = half[i][j];
    p_[j] = step(column);
    // Asymmetry by rounding grows without bound while the car is unstable.
    for (std::size_t i = 0; i < j; ++i) p_[i][j] = p_[j][i];
  }
  const double lateral = aside_.model * aside_.model, yaw = heading_.model * heading_.model;
  if (is_disturbed_) {
    p_[kLateral][kLateral] += (1.0 - fading * fading) * lateral;
    p_[kYaw][kYaw] += (1.0 - fading * fading) * yaw;
  } else {
    p_[kSlide][kSlide] += dt * kErrorTime * lateral;
    p_[kYawRate][kYawRate] += dt * kErrorTime * yaw;
  }
}

void ErrorCovariance::take(State state, double innovation, Channel& channel, bool is_after_gap,
                           Vector& correction) noexcept {
  const double unexpected = innovation - correction[state];
  const Vector column = p_[state];
  const double expected = column[state];
  if (!(expected > 0.0) || !std::isfinite(expected)) return begin();
  const double whole = std::max(expected + channel.noise(), expected / kMostShare);
  Vector gains;
  for (std::size_t i = 0; i < kStates; ++i) gains[i] = column[i] / whole;
  for (std::size_t i = 0; i < kStates; ++i)
    for (std::size_t j = 0; j < kStates; ++j) p_[i][j] -= gains[i] * column[j];
  for (std::size_t i = 0; i < kStates; ++i) correction[i] += gains[i] * unexpected;
  if (state == kAside) place_share_ = gains[kAside];

  if (is_after_gap) {
    channel.last = unexpected;
    return;
  }
  const double least = state == kAside ? kLeastLateral : kLeastYaw,
               most = state == kAside ? kMostLateral : kMostYaw;
  channel.learn(unexpected, (1.0 - gains[state]) * unexpected, whole, least, most);
}

/// Updates noise and model error by an innovation, its rest after the correction and its expected variance
/// (eq. 23, 24). The model error stays in [least, most].
void ErrorCovariance::Channel::learn(double innovation, double rest, double expected, double least,
                                     double most) noexcept {
  const double square_now = innovation * innovation / expected, product_now = innovation * last / expected;
  square += kForgetting * (innovation * rest - square);
  product += kForgetting * (innovation * last - product);
  spread += kForgetting * (square_now - spread);
  last = innovation;
  const double up = std::min(std::clamp(product_now, -1.0, 1.0), kSpreadGain * (spread - kLowSpread));
  const double surprise =
      std::clamp(square_now / (kSurprise * kSurprise), 1.0, kMostSurprise * kMostSurprise);
  model = std::clamp(model * exp(kAdapting * up) * std::sqrt(surprise), least, most);
}

ErrorCovariance::Vector ErrorCovariance::correct(const Innovation& innovation) noexcept {
  const auto [aside, heading, is_after_gap] = innovation;
  Vector correction{};
  if (std::isfinite(aside)) take(kAside, aside, aside_, is_after_gap, correction);
  if (std::isfinite(heading)) take(kHeading, heading, heading_, is_after_gap, correction);
  return correction;
}

}  // namespace chicane::tracking
