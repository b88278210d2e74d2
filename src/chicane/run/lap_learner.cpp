// SPDX-License-Identifier: MIT
#include "chicane/run/lap_learner.hpp"

#include <algorithm>
#include <cmath>

#include "chicane/base/math.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::run {
namespace {

constexpr double kShare = 0.9;        // of the first lap that a lap has to be long
constexpr double kMostTurned = 0.45;  // against the first time [rad]: roads cross at 30° or more
constexpr double kSlack = 5.0;        // [m] that a car may be farther than its speed tells

Vec2 direction_of(double heading) noexcept { return {cos(heading), sin(heading)}; }

}  // namespace

void LapLearner::reset() noexcept { *this = {}; }

void LapLearner::start(double time, const model::Pose& car) noexcept {
  reset();
  has_line_ = true;
  line_ = last_ = {car.x, car.y};
  direction_ = direction_of(car.psi);
  lap_start_ = state_.time = time;
  state_.is_timed = true;
}

void LapLearner::see(double time, const model::Pose& car, double speed) noexcept {
  const Vec2 position{car.x, car.y};
  const double moved = (position - last_).norm();
  const double elapsed = time - state_.time;
  if (!has_line_ || moved > 2.0 * speed * elapsed + kSlack) return start(time, car);
  const double before = (last_ - line_).dot(direction_);
  const Vec2 from_line = position - line_;
  const double after = from_line.dot(direction_);
  const double beside = direction_.x() * from_line.y() - direction_.y() * from_line.x();
  driven_ += moved;
  last_ = position;
  state_.time = time;
  state_.lap_time = time - lap_start_;
  if ((before < 0.0) == (after < 0.0) || std::fabs(beside) > kReach) return;
  // A road that crosses the line's own goes over the line as well, in another direction.
  const double turned = angle_difference(car.psi, atan2(direction_.y(), direction_.x()));
  const double back =
      std::min(std::fabs(turned), kPi - std::fabs(turned));  // also a car that has turned round
  if ((after > 0.0 ? std::fabs(turned) : back) > kMostTurned) return;
  if (after < 0.0) {
    ++backward_;
  } else if (backward_ > 0) {
    --backward_;
  } else {
    cross_line(time - elapsed * after / (after - before));
  }
}

void LapLearner::cross_line(double crossing) noexcept {
  const bool is_lap = driven_ >= std::max(kLeast, kShare * lap_length_);
  if (is_lap) count_lap(crossing);
  state_.lap_time = state_.time - crossing;
  lap_start_ = crossing;
  driven_ = 0.0;
}

void LapLearner::count_lap(double crossing) noexcept {
  if (lap_length_ == 0.0) lap_length_ = driven_;
  ++state_.lap;
  state_.last_lap_time = crossing - lap_start_;
  state_.last_sector_times.fill(telemetry::kNotMeasured);
  const bool is_best = state_.lap == 1 || state_.last_lap_time < state_.best_lap_time;
  if (is_best) state_.best_lap_time = state_.last_lap_time;
  state_.last_lap_was_clean = true;  // nothing is known to its discredit
}

}  // namespace chicane::run
