// SPDX-License-Identifier: MIT
#include "chicane/tracking/error_covariance.hpp"

#include <algorithm>

#include "chicane/base/math.hpp"

namespace chicane::tracking {
namespace {

constexpr double kForgetting = 0.03;  // weight of the newest innovation in means
// Deviation of the acceleration that the model lacks, at least and at most.
constexpr double kLeastLateral = 0.25, kMostLateral = 4.0;  // [m/s²]
constexpr double kLeastYaw = 0.125, kMostYaw = 2.0;         // [rad/s²]
constexpr double kErrorTime = 0.3;                          // [s] duration of such an error where it is noise
constexpr double kAdapting = 0.1;  // share of one product of innovations that a deviation follows
constexpr double kLowSpread = 0.5,
                 kSpreadGain = 2.0;    // innovations smaller than expected: the model is better
constexpr double kSurprise = 4.0;      // deviations of an innovation that show a wrong model at once
constexpr double kMostSurprise = 4.0;  // largest factor of the model's error by one innovation
// Deviations of a new estimate: the car may have started with any slide.
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
                           Vector& by) noexcept {
  const double unexpected = innovation - by[state];
  const Vector column = p_[state];
  const double expected = column[state];
  if (!(expected > 0.0) || !std::isfinite(expected)) return begin();
  const double whole = std::max(expected + channel.noise(), expected / kMostShare);
  Vector gains;
  for (std::size_t i = 0; i < kStates; ++i) gains[i] = column[i] / whole;
  for (std::size_t i = 0; i < kStates; ++i)
    for (std::size_t j = 0; j < kStates; ++j) p_[i][j] -= gains[i] * column[j];
  for (std::size_t i = 0; i < kStates; ++i) by[i] += gains[i] * unexpected;
  if (state == kAside) place_share_ = gains[kAside];

  if (is_after_gap) {
    channel.last = unexpected;
    return;
  }
  const double least = state == kAside ? kLeastLateral : kLeastYaw,
               most = state == kAside ? kMostLateral : kMostYaw;
  channel.learn(unexpected, (1.0 - gains[state]) * unexpected, whole, least, most);
}

/// Noise and model error from an innovation, what was left of it and its expected variance (eq. 23, 24).
void ErrorCovariance::Channel::learn(double innovation, double left, double expected, double least,
                                     double most) noexcept {
  const double square_now = innovation * innovation / expected, product_now = innovation * last / expected;
  square += kForgetting * (innovation * left - square);
  product += kForgetting * (innovation * last - product);
  spread += kForgetting * (square_now - spread);
  last = innovation;
  const double up = std::min(std::clamp(product_now, -1.0, 1.0), kSpreadGain * (spread - kLowSpread));
  const double surprise =
      std::clamp(square_now / (kSurprise * kSurprise), 1.0, kMostSurprise * kMostSurprise);
  model = std::clamp(model * exp(kAdapting * up) * std::sqrt(surprise), least, most);
}

ErrorCovariance::Vector ErrorCovariance::correct(const Innovation& innovation) noexcept {
  Vector by{};
  if (std::isfinite(innovation.aside)) take(kAside, innovation.aside, aside_, innovation.is_after_gap, by);
  if (std::isfinite(innovation.heading))
    take(kHeading, innovation.heading, heading_, innovation.is_after_gap, by);
  return by;
}

}  // namespace chicane::tracking
