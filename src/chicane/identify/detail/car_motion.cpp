// SPDX-License-Identifier: MIT
// Motion of the car that is identified: the four-wheel car, or the controllers' single-track model, driven by
// the commands of a log from one of its samples on.
#include "chicane/identify/detail/car_motion.hpp"

#include <algorithm>
#include <cmath>

#include "chicane/base/math.hpp"
#include "chicane/model/prediction.hpp"

namespace chicane::identify {
namespace {

constexpr double kGravity = 9.81;   // [m/s²]
constexpr double kLeastLoad = 0.1;  // least load of a wheel, share of that at rest; as model::PredictionModel
constexpr double kLeastSpeed = 0.3;    // [m/s] least rolling speed in the slip of a wheel; chosen
constexpr double kLeastSquare = 1e-8;  // added to a squared slip: no division by 0
// Damping of a tyre below kCreepSpeed, because a standing tyre is a spring (docs/model.md, eq. 19).
constexpr double kCreepSpeed = 3.0, kCreepDamping = 0.12;  // [m/s], [s/m]

/// Solves `sign` · torque · b(x) + rest = stiffness · x for the slip x. b is the share of the torque that
/// traction control or anti-lock leaves: 1 up to `limit.start`, 0 from `limit.end` on.
double slip_for(double torque, double sign, const SlipLimit& limit, double stiffness, double rest) noexcept {
  const double free = (sign * torque + rest) / stiffness;
  if (!(sign * free > limit.start)) return std::clamp(free, -1.0, 1.0);
  const double slope = torque / (limit.end - limit.start);
  const double limited = (sign * slope * limit.end + rest) / (stiffness + slope);
  return std::clamp(sign * std::min(sign * limited, limit.end), -1.0, 1.0);
}

/// e^(−x) for x >= 0 by the reciprocal of its series of fourth order: positive, absolute error below 0.012
/// for all x.
double decay(double x) noexcept {
  return 1.0 / (1.0 + x * (1.0 + x * (0.5 + x * ((1.0 / 6.0) + x * (1.0 / 24.0)))));
}

}  // namespace

FourWheels::FourWheels(const model::VehicleParams& vehicle, const Wheels& wheels, double dt) noexcept
    : vehicle_{vehicle},
      dt_{dt},
      per_relaxation_{1.0 / std::max(wheels.relaxation, 0.02)},
      load_share_{1.0 - decay(dt / std::max(wheels.load_lag - 0.5 * dt, 1e-3))},
      wheels_{wheels},
      rotating_{wheels.rotating},
      inertia_{0.25 * std::max(wheels.rotating - 1.0, 0.005)},
      turn_{vehicle.mass / vehicle.yaw_inertia},
      axles_{vehicle.axles()} {
  const double pitch = vehicle.height / kGravity;
  for (std::size_t i = 0; i < 2; ++i) {
    const model::Axle& axle = axles_[i];
    const double share = 2.0 * axle.rest;
    const double cornering = i == 0 ? vehicle.cornering_front : vehicle.cornering_rear;
    tires_[i] = {cornering / vehicle.friction, (i == 0 ? -pitch : pitch) / (share * vehicle.wheelbase()),
                 2.0 * pitch * axle.roll_share / (vehicle.track_width * share)};
  }
}

FourWheels::Motion FourWheels::steady(double vx, double vy, double r, double steer,
                                      double acceleration) const noexcept {
  Motion motion{.vx = vx, .vy = vy, .r = r};
  for (std::size_t i = 0; i < 4; ++i) {
    const model::Axle& axle = axles_[i / 2];
    const double y = i % 2 == 0 ? axle.half_track : -axle.half_track;
    const double angle = i < 2 ? steer : 0.0;
    const auto rolling =
        model::in_turned_axes(model::Planar<double>{vx - r * y, vy + r * axle.x}, cos(angle), sin(angle));
    motion.slip[i] = -rolling.y / std::max(std::fabs(rolling.x), kLeastSpeed);
    motion.rolling[i] = rolling.x - dt_ * acceleration;
    const double stiffness = vehicle_.friction * tires_[i / 2].cornering * axle.rest * kGravity;
    const double share = 0.5 * (acceleration >= 0.0 ? axle.drive_share : axle.brake_share);
    motion.slip_along[i] = std::clamp(share * acceleration / stiffness, -0.1, 0.1);
  }
  motion.along = motion.forward = acceleration;
  motion.across = motion.sideways = vx * r;
  return motion;
}

void FourWheels::advance(Motion& motion, double steer, double steer_middle, double force,
                         double drag) const noexcept {
  const double pressed = vehicle_.load(std::max(motion.vx, 0.0));
  // Load transfer depends on the weight alone, not on downforce: share of the weight in the whole load.
  const double rest = kGravity / pressed;
  // Lagged accelerations that transfer load, in the middle of the step.
  motion.along += load_share_ * (motion.forward - motion.along);
  motion.across += load_share_ * (motion.sideways - motion.across);
  const double c0 = cos(steer), s0 = sin(steer);
  const double cm = cos(steer_middle), sm = sin(steer_middle);
  motion.resistance = 0.0;
  // Force of wheel `i` on the car, by the velocity `v` of its centre.
  const auto force_of = [&](std::size_t i, const model::Axle& axle, const model::Planar<double>& v) {
    const bool is_front = i < 2;
    const Tire& tire = tires_[i / 2];
    // Slip across the wheel, with the relaxation of the tyre over one step around the start of this one.
    const model::Planar<double> w = is_front ? model::in_turned_axes(v, c0, s0) : v;
    const double rolling = std::max(std::fabs(w.x), kLeastSpeed);
    const double keeps = decay(dt_ * rolling * per_relaxation_);
    motion.slip[i] = std::clamp(-w.y / rolling + (motion.slip[i] + w.y / rolling) * keeps, -1.0, 1.0);
    const double damping = kCreepDamping * std::max(1.0 - rolling / kCreepSpeed, 0.0);
    const double slip = motion.slip[i] - damping * w.y;

    const double side = i % 2 == 0 ? -1.0 : 1.0;  // right wheels carry more in a left bend
    const double pressed_more = (is_front ? 0.5 : -0.5) * vehicle_.load_balance * (1.0 - rest) / axle.rest;
    const double part = std::max(  // load of the wheel over its load at rest
        kLeastLoad,
        1.0 + pressed_more + rest * (tire.per_along * motion.along + side * tire.per_across * motion.across));
    const double load = axle.rest * pressed * part * (1.0 + vehicle_.load_sensitivity * (1.0 - part));
    const double most = vehicle_.friction * load;
    // Slip along the wheel from the balance of torque, tyre force and inertia of the wheel, by two
    // fixed-point steps. The secant of the tyre curve is that of both slips together (similarity).
    const double z = tire.cornering * slip;
    const double inertia = inertia_ * rolling / dt_;
    const double holds_back =
        rotating_ * vehicle_.drag_constant * axle.rest * part + inertia_ * (w.x - motion.rolling[i]) / dt_;
    motion.rolling[i] = w.x;
    double& along = motion.slip_along[i];
    const double before = along;
    const auto secant = [&] {
      const double square = z * z + tire.cornering * tire.cornering * along * along;
      return model::magic_secant(vehicle_.tire_shape, square + kLeastSquare);
    };
    const double share = 0.5 * (force >= 0.0 ? axle.drive_share : axle.brake_share);
    double now = secant();
    for (int step = 0; step < 2; ++step) {
      along = slip_for(rotating_ * share * std::fabs(force), force >= 0.0 ? 1.0 : -1.0,
                       force >= 0.0 ? wheels_.drive : wheels_.brakes, most * tire.cornering * now + inertia,
                       inertia * before - holds_back);
      now = secant();
    }
    const model::Planar<double> force_here{most * tire.cornering * along * now, most * z * now};
    if (is_front) motion.resistance += sm * force_here.y;
    return force_here;
  };
  const auto sum =
      model::wheel_forces<double>(axles_, {motion.vx, motion.vy}, motion.r, cm, sm, {}, force_of);
  motion.forward = sum.x - rotating_ * (drag - vehicle_.drag_constant);
  motion.sideways = sum.y;
  const double r = motion.r + dt_ * turn_ * sum.moment;
  const double turned = 0.5 * dt_ * (motion.r + r);
  motion.r = r;
  // The axes turn under the velocity: half of the angle before and half after the forces act. Sine and cosine
  // are series of the small angle.
  const auto turn = [](double angle, double& x, double& y) {
    const double square = angle * angle;
    const double cosine = 1.0 - 0.5 * square * (1.0 - square * (1.0 / 12.0));
    const double sine = angle * (1.0 - square * (1.0 / 6.0));
    const double first = cosine * x + sine * y;
    y = cosine * y - sine * x;
    x = first;
  };
  turn(0.5 * turned, motion.vx, motion.vy);
  motion.vx += dt_ * motion.forward;
  motion.vy += dt_ * motion.sideways;
  turn(0.5 * turned, motion.vx, motion.vy);
}

namespace {

/// Means of a commanded value over intervals of time, by its integral. A command acts until the next one.
class Held {
 public:
  Held(const std::vector<SentCommand>& commands, double SentCommand::*value)
      : commands_{commands}, value_{value} {
    sums_.reserve(commands.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < commands.size(); ++i) {
      if (i > 0) sum += commands[i - 1].*value * (commands[i].time - commands[i - 1].time);
      sums_.push_back(sum);
    }
  }
  /// Mean over an interval. Intervals in the order of time are fast.
  double mean(double from, double to) { return (integral(to) - integral(from)) / (to - from); }

 private:
  /// Integral from the first command to `t` [s].
  double integral(double t) {
    while (at_ + 1 < commands_.size() && commands_[at_ + 1].time <= t) ++at_;
    while (at_ > 0 && commands_[at_].time > t) --at_;
    return sums_[at_] + commands_[at_].*value_ * (t - commands_[at_].time);
  }
  const std::vector<SentCommand>& commands_;
  double SentCommand::*value_;
  std::vector<double> sums_;  ///< integral up to each command
  std::size_t at_ = 0;        ///< command of the last time
};

/// Step of second order: twice the change of the model's linearly implicit step of dt/2, and as stable. A
/// step of first order has numerical damping, which the fit would attribute to inertia and lags. The front
/// slip of the model is linear in angles; `linear` is the steering angle that makes it equal to the true
/// slip.
model::BodyMotion<double> midpoint_step(const model::PredictionModel& model, const Car& car,
                                        const model::BodyMotion<double>& from, double steer,
                                        double acceleration, double dt) noexcept {
  constexpr double kLeast = 1.0;  // [m/s] least speed in the slip angle; chosen
  const double across = (from.vy + car.vehicle.front_axle * from.r) / std::max(from.vx, kLeast);
  const double linear = steer + across - atan(across);
  model::BodyMotion<double> to = model.advance(from, linear, acceleration, 0.5 * dt);
  to.vx = 2.0 * to.vx - from.vx;
  to.vy = 2.0 * to.vy - from.vy;
  to.r = 2.0 * to.r - from.r;
  return to;
}

/// Speed and acceleration by measured speeds: a least-squares line through the samples around a moment.
class MeasuredSpeed {
 public:
  explicit MeasuredSpeed(const std::vector<Sample>& samples) : samples_{samples} {}
  struct Speed {
    double value = 0.0;         ///< [m/s]
    double acceleration = 0.0;  ///< [m/s²]
  };
  /// Speed at a moment. Pre: moments come in order.
  Speed at(double t) {
    while (first_ + 1 < samples_.size() && samples_[first_].time < t - kReach) ++first_;
    double count = 0.0, sum_t = 0.0, sum_v = 0.0, tt = 0.0, tv = 0.0;
    for (std::size_t i = first_; i < samples_.size() && samples_[i].time <= t + kReach; ++i) {
      const double dt = samples_[i].time - t;
      count += 1.0;
      sum_t += dt;
      sum_v += samples_[i].speed;
      tt += dt * dt;
      tv += dt * samples_[i].speed;
    }
    const double spread = count * tt - sum_t * sum_t;
    if (count < 3.0 || !(spread > 1e-9)) return {samples_[first_].speed, 0.0};
    const double slope = (count * tv - sum_t * sum_v) / spread;
    return {(sum_v - slope * sum_t) / count, slope};
  }

  /// Time of used samples on each side of the moment [s]; chosen.
 private:
  static constexpr double kReach = 0.15;
  const std::vector<Sample>& samples_;
  std::size_t first_ = 0;  ///< first sample in reach of the last moment
};

/// Steering angle at the end of a step, and its mean over the step [rad].
struct Followed {
  double end, mean;
};
/// Steering from `steer` towards `asked` over a step: at the rate limit `rate` [rad/s], then with the `lag`
/// [s] once that is slower. `alone`: the lag without a rate limit.
Followed follow(double steer, double asked, double lag, double rate,
                const model::PredictionModel::Lag& alone) {
  const double apart = std::fabs(asked - steer);
  if (!(apart > rate * lag))
    return {asked + (steer - asked) * alone.end, asked + (steer - asked) * alone.mean};
  const double ramp = std::min(apart / rate - lag, Actuators::kStep);
  const double left = apart - rate * ramp;  // angle that remains after the ramp
  const double rest = Actuators::kStep - ramp;
  const double decay = lag > 1e-4 ? exp(-rest / lag) : (rest > 0.0 ? 0.0 : 1.0);
  const double area = (apart - 0.5 * rate * ramp) * ramp + left * lag * (1.0 - decay);
  return {asked + std::copysign(left * decay, steer - asked),
          asked + std::copysign(area / Actuators::kStep, steer - asked)};
}

}  // namespace

Actuators::Actuators(const DriveLog& log, const Car& car) : start_{log.samples.front().time} {
  const auto count = static_cast<std::size_t>((log.samples.back().time - start_) / kStep) + 2;
  const model::PredictionModel model(car.vehicle);
  const auto lags = model.lags(kStep);
  Held steering(log.commands, &SentCommand::steer);
  Held pedal(log.commands, &SentCommand::throttle);
  const bool has_throttle = log.has_throttle();
  MeasuredSpeed measured(log.samples);
  points_.reserve(count);
  std::size_t sample = 0;
  double steer = log.commands.front().steer;
  double acceleration = 0.0;
  double pressed = 0.0;
  const double most_steer = car.vehicle.steer_limit;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = start_ + kStep * static_cast<double>(i);
    while (sample + 2 < log.samples.size() && log.samples[sample + 1].time <= t) ++sample;
    const Sample& a = log.samples[sample];
    const Sample& b = log.samples[std::min(sample + 1, log.samples.size() - 1)];
    const double share = b.time > a.time ? std::clamp((t - a.time) / (b.time - a.time), 0.0, 1.0) : 0.0;
    const MeasuredSpeed::Speed alone = has_throttle ? MeasuredSpeed::Speed{} : measured.at(t);
    const double speed = has_throttle ? a.speed + share * (b.speed - a.speed) : alone.value;
    const double asked =
        std::clamp(steering.mean(t - car.delay, t - car.delay + kStep), -most_steer, most_steer);
    const double throttle =
        has_throttle ? std::clamp(pedal.mean(t - car.delay, t - car.delay + kStep), -1.0, 1.0) : 0.0;
    const double wanted =
        has_throttle ? model::longitudinal_acceleration(car.vehicle, throttle, speed) : alone.acceleration;
    if (i == 0) {
      acceleration = wanted;
      pressed = throttle;
    }
    const Followed followed =
        follow(steer, asked, car.vehicle.steer_lag, car.vehicle.steer_rate_limit, lags.steer);
    points_.push_back({steer, followed.mean, acceleration, throttle, pressed, speed});
    steer = followed.end;
    pressed = throttle + (pressed - throttle) * lags.drive.end;
    acceleration = has_throttle ? wanted + (acceleration - wanted) * lags.drive.end : wanted;
  }
}

namespace {

/// Position [m] and yaw [rad] of the centre of mass in W.
struct Place {
  double x, y, psi;
};

/// Sample of the log `ahead` [s] after the car was at `at`; velocities in the car's axes [m/s].
Expected seen_at(const Car& car, const Place& at, double ahead, double vx, double vy, double r,
                 double acceleration, double steer) {
  const double course = at.psi + 0.5 * ahead * r;
  const double x = at.x + ahead * (vx * cos(course) - vy * sin(course));
  const double y = at.y + ahead * (vx * sin(course) + vy * cos(course));
  const double yaw = at.psi + ahead * r;
  const double speed = hypot(vx + ahead * acceleration, vy + car.reference * r);
  return {x + car.reference * cos(yaw), y + car.reference * sin(yaw), yaw, speed, r, vx, vy, steer};
}

/// Moves `at` by one step, with the mean of the velocities at both ends.
void move(Place& at, double dt, double vx, double vy, double r, double next_vx, double next_vy,
          double next_r) {
  const double course = at.psi + 0.25 * dt * (r + next_r);
  const double along = 0.5 * (vx + next_vx), across = 0.5 * (vy + next_vy);
  at.x += dt * (along * cos(course) - across * sin(course));
  at.y += dt * (along * sin(course) + across * cos(course));
  at.psi += 0.5 * dt * (r + next_r);
}

/// Predicts samples first … last - 1: calls `advance(i)` for each step of the grid from point i on, and
/// `seen(i, ahead)` for the sample `ahead` [s] after point i.
template <class Advance, class Seen>
void follow_samples(const DriveLog& log, const Actuators& actuators, std::size_t first, std::size_t last,
                    const Advance& advance, const Seen& seen, std::vector<Expected>& expected) {
  double t = log.samples[first].time;
  std::size_t i = actuators.nearest(t);
  for (std::size_t sample = first; sample < last; ++sample) {
    const double until = log.samples[sample].time;
    for (; until - t >= Actuators::kStep && i + 1 < actuators.size(); t += Actuators::kStep) advance(i++);
    expected.push_back(seen(i, until - t));
  }
}

/// Drives by the controllers' single-track model.
void drive_single_track(const Car& car, const DriveLog& log, const Actuators& actuators, std::size_t first,
                        std::size_t last, const Start& start, std::vector<Expected>& expected) {
  constexpr double kStep = Actuators::kStep;
  const model::PredictionModel model(car.vehicle);
  const auto lags = model.lags(kStep);
  const bool has_throttle = log.has_throttle();
  Place at{start[0], start[1], start[2]};
  model::BodyMotion<double> now{start[3], start[4], start[5], 0.0, 0.0};
  now.acceleration = actuators[actuators.nearest(log.samples[first].time)].acceleration;
  const auto advance = [&](std::size_t i) {
    const double steer = 0.5 * (actuators[i].steer + actuators[i + 1].steer) + car.steer_offset;
    // Without a pedal in the log the car has the measured acceleration.
    const double wanted = has_throttle
                              ? model::longitudinal_acceleration(car.vehicle, actuators[i].throttle, now.vx)
                              : actuators[i].acceleration;
    const double mean = has_throttle ? wanted + (now.acceleration - wanted) * lags.drive.mean : wanted;
    model::BodyMotion<double> next = midpoint_step(model, car, now, steer, mean, kStep);
    next.acceleration = has_throttle ? wanted + (now.acceleration - wanted) * lags.drive.end : wanted;
    if (!has_throttle) next.vx = now.vx + actuators[i + 1].speed - actuators[i].speed;
    move(at, kStep, now.vx, now.vy, now.r, next.vx, next.vy, next.r);
    now = next;
  };
  const auto seen = [&](std::size_t i, double ahead) {
    return seen_at(car, at, ahead, now.vx, now.vy, now.r, now.acceleration,
                   actuators[i].steer + car.steer_offset);
  };
  follow_samples(log, actuators, first, last, advance, seen, expected);
}

/// Drives by FourWheels.
void drive_four_wheels(const Car& car, const DriveLog& log, const Actuators& actuators, std::size_t first,
                       std::size_t last, const Start& start, std::vector<Expected>& expected) {
  constexpr double kStep = Actuators::kStep;
  const FourWheels wheels(car.vehicle, car.wheels, kStep);
  Place at{start[0], start[1], start[2]};
  const auto steer_at = [&](std::size_t n) { return actuators[n].steer + car.steer_offset; };
  const auto steer_mean = [&](std::size_t n) { return actuators[n].steer_mean + car.steer_offset; };
  const std::size_t begin = actuators.nearest(log.samples[first].time);
  FourWheels::Motion now =
      wheels.steady(start[3], start[4], start[5], steer_at(begin), actuators[begin].acceleration);
  const auto advance = [&, has_throttle = log.has_throttle()](std::size_t i) {
    const FourWheels::Motion before = now;
    const double drag = -model::longitudinal_acceleration(car.vehicle, 0.0, now.vx);
    const double pedal = 0.5 * (actuators[i].pedal + actuators[i + 1].pedal);
    // Without a pedal in the log the force keeps the measured speed.
    const double force = has_throttle ? model::longitudinal_acceleration(car.vehicle, pedal, now.vx) + drag
                                      : (actuators[i + 1].speed - actuators[i].speed) / kStep -
                                            now.r * now.vy + now.resistance + drag;
    wheels.advance(now, 0.5 * (steer_mean(i > 0 ? i - 1 : i) + steer_mean(i)), steer_mean(i), force, drag);
    if (!has_throttle) now.vx = before.vx + actuators[i + 1].speed - actuators[i].speed;
    move(at, kStep, before.vx, before.vy, before.r, now.vx, now.vy, now.r);
  };
  const auto seen = [&](std::size_t i, double ahead) {
    return seen_at(car, at, ahead, now.vx, now.vy, now.r, now.forward + now.r * now.vy, steer_at(i));
  };
  follow_samples(log, actuators, first, last, advance, seen, expected);
}

}  // namespace

void drive(const Car& car, const DriveLog& log, const Actuators& actuators, std::size_t first,
           std::size_t last, const Start& start, std::vector<Expected>& expected) {
  expected.clear();
  const auto drive_by = has_four_wheels(car.vehicle) ? drive_four_wheels : drive_single_track;
  drive_by(car, log, actuators, first, last, start, expected);
}

}  // namespace chicane::identify
