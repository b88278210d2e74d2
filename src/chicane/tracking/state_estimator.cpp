// SPDX-License-Identifier: MIT
// Estimates of the car: commands in flight, direction of travel, state by prediction and correction,
// and grip by least squares over the innovations of three estimators.
#include "chicane/tracking/state_estimator.hpp"

#include <cmath>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/model/actuator.hpp"

namespace chicane::tracking {

void CommandHistory::add(double time, const model::Command& command) noexcept {
  while (count_ > 0 && entries_[count_ - 1].time >= time) --count_;
  if (count_ == kCapacity) {
    std::shift_left(entries_.begin(), entries_.end(), 1);
    --count_;
  }
  entries_[count_++] = {time, command};
}

model::Command CommandHistory::at(double time) const noexcept {
  for (std::size_t i = count_; i-- > 0;)
    if (entries_[i].time <= time) return entries_[i].command;
  return {};
}

double CommandHistory::lowest_throttle(double from, double until) const noexcept {
  double lowest = at(from).throttle;
  for (std::size_t i = 0; i < count_; ++i)
    if (entries_[i].time > from && entries_[i].time <= until)
      lowest = std::min(lowest, entries_[i].command.throttle);
  return lowest;
}

double CommandHistory::next_change(double time, double limit) const noexcept {
  std::size_t next = count_;  // from the latest on: a search begins among the commands in flight
  while (next > 0 && entries_[next - 1].time > time) --next;
  return next < count_ ? std::min(entries_[next].time, limit) : limit;
}

namespace {

constexpr double kMaxStep =
    0.01;  // [s] integration step of the estimator; chosen: the model's error is O(dt²)
constexpr double kRounding = 1e-9;  // [s] rounding of times
constexpr double kLostPosition =
    3.0;  // [m] distance of a measurement from its prediction that restarts; chosen
constexpr double kLostHeading = 0.5;    // [rad] the same of the heading; chosen
constexpr double kAtRest = 0.3;         // [m/s] speed below which a car has no direction; chosen
constexpr double kMostlyAlong = 0.5;    // share of the way that shows a direction; chosen
constexpr double kMostDisplaced = 1.5;  // displacement over the way by speed that shows a reset; chosen
constexpr double kUncertain = 1.0;      // [m] added to that for a noisy sensor; chosen
constexpr double kRestingSpeed = 2.0;   // [m/s] speed below which the drive that stops a car fades; chosen

}  // namespace

void StateEstimator::advance_errors(ErrorCovariance& errors, const model::BodyMotion<double>& from,
                                    const model::BodyMotion<double>& to, double steer, double asked,
                                    double dt, const model::PredictionModel::Lags& lags) const noexcept {
  // Finite differences to the side that the car turns to, so that a mirrored car has mirrored slopes.
  const double slide = std::copysign(0.01, from.r);      // [m/s]
  const double yaw_rate = std::copysign(0.001, from.r);  // [rad/s]
  model::BodyMotion<double> slid = from, turned = from;
  slid.vy += slide;
  turned.r += yaw_rate;
  slid = model_.advance(slid, steer, asked, dt, lags);
  turned = model_.advance(turned, steer, asked, dt, lags);
  errors.advance(dt, from.vx,
                 {.slide_by_slide = (slid.vy - to.vy) / slide,
                  .slide_by_yaw_rate = (turned.vy - to.vy) / yaw_rate,
                  .yaw_rate_by_slide = (slid.r - to.r) / slide,
                  .yaw_rate_by_yaw_rate = (turned.r - to.r) / yaw_rate},
                 Disturbance::kTime / (Disturbance::kTime + dt));
}

void StateEstimator::advance(Prediction& at, double from, double to, const CommandHistory& sent,
                             ErrorCovariance* errors) const noexcept {
  const model::VehicleParams& p = model_.vehicle();
  model::State& state = at.state;
  double now = from;
  double lags_dt = 0.0;  // [s] length of the step that `lags` are for
  model::PredictionModel::Lags lags;
  while (now < to - kRounding) {
    const double dt = std::min(sent.next_change(now + kRounding, to) - now, kMaxStep);
    const model::Command command = sent.at(now + kRounding);
    if (dt != lags_dt) {
      lags = model_.lags(dt);
      lags_dt = dt;
    }
    // The demand is limited so that the wheel behind its lag keeps to its rate.
    const double reach = p.steer_rate_limit * dt / (1.0 - lags.steer.end);
    const double steer = std::clamp(command.steer, state.steer - reach, state.steer + reach);
    const double asked = longitudinal_acceleration(p, command.throttle, state.vx);
    const model::BodyMotion<double> before{state.vx, state.vy, state.r, state.steer, at.acceleration};
    model::BodyMotion<double> body = model_.advance(before, steer, asked, dt, lags);
    if (errors != nullptr) advance_errors(*errors, before, body, steer, asked, dt, lags);
    body.vy += dt * at.disturbance.lateral;
    body.r += dt * at.disturbance.yaw;
    at.disturbance.fade(dt);
    const double psi = state.psi + 0.5 * dt * (state.r + body.r);
    if (minds_gap_ && model::helper_gap_within(state.psi, psi) > 0.0) {
      const double turn = model::helper_gap_turn(p, state.r), along = body.vx;
      body.vx += turn * body.vy;
      body.vy -= turn * along;
    }
    const double mean_psi = 0.5 * (state.psi + psi);
    const double vx = 0.5 * (state.vx + body.vx);
    const double vy = 0.5 * (state.vy + body.vy);
    const auto [sine, cosine] = sine_cosine(mean_psi);
    state.x += dt * (vx * cosine - vy * sine);
    state.y += dt * (vx * sine + vy * cosine);
    state.psi = psi;
    state.vx = std::max(body.vx, 0.0);
    state.vy = body.vy;
    state.r = body.r;
    state.steer = body.steer;
    at.acceleration = body.acceleration;
    now += dt;
  }
}

void DirectionWatch::see(const model::Measurement& now) noexcept {
  const double elapsed = now.time - time_;
  if (has_last_ && elapsed <= 0.0) return;  // an old or repeated measurement
  if (!now.is_finite() || now.speed < kAtRest) return reset();
  const double dx = now.x - x_;
  const double dy = now.y - y_;
  const double way = now.speed * elapsed;
  if (!has_last_ || elapsed > StateEstimator::kLongestGap ||
      hypot(dx, dy) > kMostDisplaced * way + kUncertain) {
    path_ = along_ = 0.0;  // the first measurement, or the car was put elsewhere
  } else {
    path_ += way;
    along_ += dx * cos(now.psi) + dy * sin(now.psi);
  }
  if (path_ >= kPath) {
    if (std::fabs(along_) > kMostlyAlong * path_) rolls_back_ = along_ < 0.0;
    path_ = along_ = 0.0;
  }
  has_last_ = true;
  time_ = now.time;
  x_ = now.x;
  y_ = now.y;
}

double throttle_against_rolling_back(const model::VehicleParams& vehicle, double speed) noexcept {
  if (vehicle.reverse_speed > 0.0) return std::clamp(speed / kRestingSpeed, 0.0, 1.0);
  const double braking = longitudinal_acceleration(vehicle, -vehicle.brake_throttle_limit, speed);
  return throttle_to_rest(vehicle, braking, speed);
}

void StateEstimator::correct(const model::Measurement& now, const CommandHistory& sent) noexcept {
  const double elapsed = now.time - time_;
  direction_.see(now);
  surprise_ = {};
  const bool goes_on = is_started_ && elapsed > 0.0 && elapsed < kLongestGap;
  if (!now.is_finite() && !goes_on) return;
  if (goes_on) {
    advance(now_, time_, now.time, sent, average_ > 0.0 ? nullptr : &errors_);
    const double dx = now.x - now_.state.x;
    const double dy = now.y - now_.state.y;
    const double dpsi = angle_difference(now.psi, now_.state.psi);
    const bool is_near = dx * dx + dy * dy < kLostPosition * kLostPosition && std::fabs(dpsi) < kLostHeading;
    if (!now.is_finite() || is_near) {
      surprise_ = {dy * cos(now_.state.psi) - dx * sin(now_.state.psi), dpsi};
      take_over(now, dx, dy, dpsi);
      return;
    }
  } else if (is_started_ && elapsed <= 0.0 && elapsed > -kLongestGap) {
    return;  // an old or repeated measurement
  }
  const double steer = std::isfinite(now.steer) ? now.steer : 0.0;
  now_ = {};
  now_.state = {.x = now.x,
                .y = now.y,
                .psi = now.psi,
                .vx = now.speed,
                .vy = 0.0,
                .r = now.speed * tan(std::clamp(steer, -0.6, 0.6)) / model_.vehicle().wheelbase(),
                .steer = steer};
  time_ = place_seen_ = heading_seen_ = now.time;
  errors_.begin();
  is_started_ = true;
}

/// By the covariance, or by the fixed gains of average_over(). Without a position the heading alone corrects.
StateEstimator::Correction StateEstimator::correction(double aside, double heading, double elapsed,
                                                      bool is_after_gap) noexcept {
  using Errors = ErrorCovariance;
  if (!(average_ > 0.0)) {
    const Errors::Vector by = errors_.correct({aside, heading, is_after_gap});
    return {by, errors_.place_share()};
  }
  Errors::Vector by{};
  const double root = is_after_gap ? std::sqrt(1.0 - Errors::kMostShare) : exp(-elapsed / average_);
  const double place = 1.0 - root * root;
  const double velocity = is_after_gap ? 0.0 : 2.0 * (1.0 - root) * (1.0 - root) / elapsed;
  if (std::isfinite(aside)) by[Errors::kAside] = place * aside, by[Errors::kSlide] = velocity * aside;
  by[Errors::kHeading] = place * heading;
  by[Errors::kYawRate] = velocity * heading;
  return {by, place};
}

/// Equation 21 of docs/controller.md, for the measured part of a measurement. Without a measured speed the
/// displacement along the car corrects the speed.
void StateEstimator::take_over(const model::Measurement& now, double dx, double dy, double dpsi) noexcept {
  using Errors = ErrorCovariance;
  const double before = std::exchange(time_, now.time);
  model::State& state = now_.state;
  Disturbance& push = now_.disturbance;
  if (std::isfinite(dpsi)) {
    const bool has_place = std::isfinite(dx) && std::isfinite(dy);
    const auto [sine, cosine] = sine_cosine(state.psi);
    const double along = dx * cosine + dy * sine, aside = dy * cosine - dx * sine;
    const double elapsed = now.time - before;
    const bool is_after_gap = before > heading_seen_ || (has_place && before > place_seen_);
    const auto [by, share] = correction(aside, dpsi, elapsed, is_after_gap);
    heading_seen_ = now.time;
    if (has_place) {
      const double unseen = now.time - std::exchange(place_seen_, now.time);
      state.x += share * along * cosine - by[Errors::kAside] * sine;
      state.y += share * along * sine + by[Errors::kAside] * cosine;
      constexpr double kSpeedGain = 0.25;  // share of the displacement's speed; chosen
      if (!std::isfinite(now.speed)) state.vx = std::max(0.0, state.vx + kSpeedGain * share * along / unseen);
    }
    state.psi += by[Errors::kHeading];
    state.vy += by[Errors::kSlide];
    state.r += by[Errors::kYawRate];
    if (is_disturbed_) {
      push.lateral = std::clamp(push.lateral + by[Errors::kLateral], -kMostLateral, kMostLateral);
      push.yaw = std::clamp(push.yaw + by[Errors::kYaw], -kMostYaw, kMostYaw);
    }
  }
  if (std::isfinite(now.speed))
    state.vx = std::sqrt(std::max(0.0, now.speed * now.speed - state.vy * state.vy));
}

StateEstimator::Prediction StateEstimator::predict(double time, const CommandHistory& sent) const noexcept {
  Prediction result = now_;
  advance(result, time_, std::min(time, time_ + kLongestGap), sent);
  return result;
}

double StateEstimator::rolling_speed(double time, const CommandHistory& sent) const noexcept {
  const double to = std::min(time, time_ + kLongestGap);
  double speed = now_.state.vx;
  for (double now = time_; now < to - kRounding;) {
    const double dt = std::min(sent.next_change(now + kRounding, to) - now, kMaxStep);
    const double pedal = sent.at(now + kRounding).throttle;
    speed = std::max(speed + dt * longitudinal_acceleration(model_.vehicle(), pedal, speed), 0.0);
    now += dt;
  }
  return speed;
}

namespace {

constexpr double kLongestSilence =
    0.25;  // [s] longer pauses are left out: the estimators settle first; chosen
constexpr double kPerfectSensor = 1e-8;  // [m²] least variance: of a perfect sensor; chosen
constexpr double kFarAside = 1.0;        // [m] lateral innovation that is no noise and is left out; chosen

}  // namespace

void GripEstimator::begin(const StateEstimator& from, const model::PredictionModel& assumed) noexcept {
  const auto copy = [&](double share) {
    StateEstimator estimator = from;
    estimator.estimate_disturbance(false);
    estimator.set_model(model::PredictionModel{model::with_grip(assumed.vehicle(), share)});
    return estimator;
  };
  *this = GripEstimator{copy(1.0), copy(1.0 - kStep), copy(1.0)};
}

void GripEstimator::see(const model::Measurement& now, const CommandHistory& sent) noexcept {
  const double elapsed = now.time - assumed_.time();
  assumed_.correct(now, sent);
  less_.correct(now, sent);
  model::Measurement later = now;
  later.time -= kLate;  // seen from an earlier time all commands act later
  late_.correct(later, sent);
  const double n = assumed_.surprise().aside, less = less_.surprise().aside;
  const bool is_seen =
      elapsed > 0.0 && elapsed < kLongestSilence && std::fabs(n) < kFarAside && std::isfinite(less);
  const model::State& car = assumed_.state();
  const double by_tyres = (1.0 - assumed_.model().vehicle().steer_helper) * car.vx * car.r;
  const bool goes_on = std::fabs(by_tyres) > 0.5 * kLeast && by_tyres * side_ >= 0.0;
  if (bend_time_ >= (goes_on ? kLongestBend : kShortestBend)) end_bend();
  if (!is_seen || !(std::fabs(by_tyres) >= kLeast)) return;
  side_ = by_tyres;
  const double left = kMemory / (kMemory + elapsed);
  time_ = left * time_ + elapsed;
  interval_ = interval_ > 0.0 ? interval_ + 0.05 * (elapsed - interval_) : elapsed;
  const double h = (less - n) / kStep;
  all_.add(h, n, left, elapsed);
  bend_.add(h, n, 1.0, elapsed);
  bend_time_ += elapsed;
  const double off = assumed_.surprise().heading, late = late_.surprise().heading;
  if (!std::isfinite(late)) return;
  off_ = left * off_ + elapsed * off * off;
  by_time_ = left * by_time_ + elapsed * (late - off) * (late - off) / (kLate * kLate);
}

void GripEstimator::end_bend() noexcept {
  const double once = kMemory / (kMemory + bend_time_), left = once * once;  // products of sums fade twice
  bends_ = {.hnhn = left * bends_.hnhn + bend_.hn * bend_.hn,
            .hnhh = left * bends_.hnhh + bend_.hn * bend_.hh,
            .hhhh = left * bends_.hhhh + bend_.hh * bend_.hh,
            .count = bends_.count + 1};
  bend_ = {};
  bend_time_ = 0.0;
}

void GripEstimator::Sums::add(double h, double n, double left, double elapsed) noexcept {
  hh = left * hh + elapsed * h * h;
  hn = left * hn + elapsed * h * n;
  nn = left * nn + elapsed * n * n;
}

double GripEstimator::Sums::variance(double time) const noexcept {
  const double explained = hh > 0.0 ? hn * hn / hh : 0.0;
  return std::max((nn - explained) / time, kPerfectSensor);
}

double GripEstimator::share() const noexcept {
  return is_known() ? std::clamp(1.0 + all_.hn / all_.hh, kLow, kHigh) : 1.0;
}

double GripEstimator::unsure_time() const noexcept {
  return by_time_ > 0.0 ? std::sqrt(off_ / by_time_) : std::numeric_limits<double>::infinity();
}

bool GripEstimator::differs(double least) const noexcept {
  return is_known() && std::fabs(share() - 1.0) > std::max(least, 2.0 * deviation());
}

double GripEstimator::deviation() const noexcept {
  if (!(all_.hh > 0.0) || bends_.count < 2) return std::numeric_limits<double>::infinity();
  const double by_noise = interval_ * all_.variance(time_) / all_.hh;
  const double d = all_.hn / all_.hh;
  const double scatter = std::max(bends_.hnhn - 2.0 * d * bends_.hnhh + d * d * bends_.hhhh, 0.0);
  const double n = std::min(static_cast<double>(bends_.count), kMemory / kShortestBend);
  const double by_bends = n / (n - 1.0) * scatter / (all_.hh * all_.hh);  // n - 1 degrees of freedom
  return std::sqrt(std::max(by_noise, by_bends));
}

}  // namespace chicane::tracking
