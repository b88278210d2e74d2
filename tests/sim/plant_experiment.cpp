// SPDX-License-Identifier: MIT
#include "sim/plant_experiment.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "chicane/base/random.hpp"

namespace chicane::sim::experiment {

namespace {

Sample sample(const Plant& plant, double time) {
  const model::State& s = plant.state();
  const PlantOutput& o = plant.output();
  return {.time = time, .speed = o.speed, .ax = o.ax, .ay = o.ay, .x = s.x, .y = s.y, .r = s.r, .vy = s.vy};
}

int steps(const Plant& plant, double duration) {
  return static_cast<int>(duration / plant.step_length() + 0.5);
}

/// A drive at a held speed with random steps of the wheel, for identification.
struct Log {
  double dt = 0.0;
  std::vector<model::State> states;
};

Log record(Plant& plant, const model::VehicleParams& params, double speed, double lateral) {
  plant.reset({}, speed);
  SpeedHold hold{speed};
  Random random{17};
  const double amplitude = std::min(lateral * params.wheelbase() / (speed * speed), params.steer_limit);
  Log log{.dt = plant.step_length(), .states = {}};
  double wish = 0.0;
  for (int i = 0; i < steps(plant, 20.0); ++i) {
    if (i % steps(plant, 0.5) == 0) wish = random.uniform(-amplitude, amplitude);
    plant.advance({.steer = wish, .throttle = hold.throttle(plant)});
    log.states.push_back(plant.state());
  }
  return log;
}

/// Velocity of a car along and across its own axes [m/s], and yaw rate [rad/s]; or how fast they change.
struct Motion {
  double vx = 0.0, vy = 0.0, r = 0.0;
};

/// The textbook single track by which the plants are judged (docs/model.md, eq. 2–6): front and rear wheel
/// with saturating tyres, without drive, roll, load transfer and coupling of longitudinal to lateral force.
Motion derivative(const model::VehicleParams& p, const Motion& now, double steer) {
  constexpr double kSlipSpeed = 3.0;  // [m/s]: lateral stiffness is that of at least this speed
  const double reciprocal = 1.0 / std::sqrt(now.vx * now.vx + kSlipSpeed * kSlipSpeed);
  const double slip_front =
      (now.vx * std::sin(steer) - (now.vy + p.front_axle * now.r) * std::cos(steer)) * reciprocal;
  const double slip_rear = (p.rear_axle * now.r - now.vy) * reciprocal;
  const double pressed = (p.load_constant + p.load_per_speed * now.vx) * (p.friction / p.wheelbase());
  const double front = pressed * p.rear_axle * std::tanh(slip_front * (p.cornering_front / p.friction));
  const double rear = pressed * p.front_axle * std::tanh(slip_rear * (p.cornering_rear / p.friction));
  const double turning = (1.0 - p.steer_helper) * now.r;
  const double front_across = front * std::cos(steer);
  return {.vx = turning * now.vy - front * std::sin(steer),
          .vy = front_across + rear - turning * now.vx,
          .r = (p.front_axle * front_across - p.rear_axle * rear) * (p.mass / p.yaw_inertia)};
}

/// One classical Runge–Kutta step.
Motion advanced(const model::VehicleParams& params, const Motion& now, double steer, double dt) {
  const auto moved = [&now](const Motion& rate, double time) {
    return Motion{now.vx + time * rate.vx, now.vy + time * rate.vy, now.r + time * rate.r};
  };
  const Motion k1 = derivative(params, now, steer);
  const Motion k2 = derivative(params, moved(k1, 0.5 * dt), steer);
  const Motion k3 = derivative(params, moved(k2, 0.5 * dt), steer);
  const Motion k4 = derivative(params, moved(k3, dt), steer);
  const auto mean = [](double a, double b, double c, double d) { return (a + 2.0 * b + 2.0 * c + d) / 6.0; };
  return moved(
      {mean(k1.vx, k2.vx, k3.vx, k4.vx), mean(k1.vy, k2.vy, k3.vy, k4.vy), mean(k1.r, k2.r, k3.r, k4.r)}, dt);
}

/// The single track with the log's steering angle and speed against the log.
Mismatch compare_with(const Log& log, const model::VehicleParams& params) {
  Motion motion{.vx = log.states.front().vx};
  double r_error = 0.0, r_size = 0.0, v_error = 0.0, v_size = 0.0;
  for (const model::State& truth : log.states) {
    motion = advanced(params, motion, truth.steer, log.dt);
    motion.vx = truth.vx;
    r_error += std::pow(motion.r - truth.r, 2);
    r_size += std::pow(truth.r, 2);
    v_error += std::pow(motion.vy - truth.vy, 2);
    v_size += std::pow(truth.vy, 2);
  }
  return {std::sqrt(r_error / r_size), std::sqrt(v_error / v_size)};
}

}  // namespace

Line fit_line(const std::vector<std::pair<double, double>>& points) {
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixX2d a(n, 2);
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    a.row(i) << 1.0, points[static_cast<std::size_t>(i)].first;
    b(i) = points[static_cast<std::size_t>(i)].second;
  }
  const Eigen::Vector2d line = a.householderQr().solve(b);
  return {line(0), line(1), (a * line - b).norm() / std::sqrt(static_cast<double>(n))};
}

std::vector<Sample> drive_straight(Plant& plant, double throttle, double duration) {
  std::vector<Sample> run{sample(plant, 0.0)};
  for (int i = 1; i <= steps(plant, duration); ++i) {
    plant.advance({.steer = 0.0, .throttle = throttle});
    run.push_back(sample(plant, i * plant.step_length()));
  }
  return run;
}

std::vector<std::pair<double, double>> accelerations(const std::vector<Sample>& run, double skip) {
  std::vector<std::pair<double, double>> points;
  const auto window = static_cast<std::size_t>(0.2 / (run[1].time - run[0].time) + 0.5);
  for (std::size_t i = 0; i + window < run.size(); i += window) {
    const Sample& a = run[i];
    const Sample& b = run[i + window];
    if (a.time >= skip)
      points.emplace_back(0.5 * (a.speed + b.speed), (b.speed - a.speed) / (b.time - a.time));
  }
  return points;
}

double time_to(const std::vector<Sample>& run, double speed) {
  for (std::size_t i = 1; i < run.size(); ++i) {
    if (run[i].speed >= speed) {
      const double share = (speed - run[i - 1].speed) / (run[i].speed - run[i - 1].speed);
      return run[i - 1].time + share * (run[i].time - run[i - 1].time);
    }
  }
  return -1.0;
}

double braking_at(Plant& plant, double throttle, double speed) {
  // A hard brake needs room to build up, a gentle one should not take minutes.
  plant.reset({}, speed + (throttle < -0.035 ? 5.0 : 1.5));
  std::vector<std::pair<double, double>> points;
  for (const Sample& s : drive_straight(plant, throttle, 15.0)) {
    if (s.speed < speed - 0.75) break;
    if (s.speed <= speed + 0.75) points.emplace_back(s.time, s.speed);
  }
  return points.size() < 3 ? 0.0 : fit_line(points).slope;
}

double SpeedHold::throttle(const Plant& plant) {
  const double error = speed_ - plant.output().speed;
  sum_ = std::clamp(sum_ + 0.5 * error * plant.step_length(), 0.0, 1.0);
  return std::clamp(0.5 * error + sum_, 0.0, 1.0);
}

Circle steady_circle(Plant& plant, double steer, double speed, double settle) {
  plant.reset({}, speed);
  SpeedHold hold{speed};
  for (int i = 0; i < steps(plant, settle); ++i)
    plant.advance({.steer = steer, .throttle = hold.throttle(plant)});
  // Means over 2 s, beyond the ripple of one step.
  const int count = steps(plant, 2.0);
  Circle circle;
  for (int i = 0; i < count; ++i) {
    plant.advance({.steer = steer, .throttle = hold.throttle(plant)});
    circle.yaw_rate += plant.state().r / count;
    circle.speed += plant.output().speed / count;
    circle.lateral_acceleration += plant.output().ay / count;
    circle.sideslip += std::atan2(plant.state().vy, plant.state().vx) / count;
  }
  circle.curvature = circle.yaw_rate / circle.speed;
  circle.path_radius = 1.0 / circle.curvature;
  return circle;
}

std::pair<std::complex<double>, std::complex<double>> yaw_modes(Plant& plant, double speed) {
  plant.reset({}, speed);
  SpeedHold hold{speed};
  for (int i = 0; i < steps(plant, 3.0); ++i) plant.advance({.steer = 0.0, .throttle = hold.throttle(plant)});
  for (int i = 0; i < steps(plant, 0.06); ++i)
    plant.advance({.steer = 1e-3, .throttle = hold.throttle(plant)});
  for (int i = 0; i < steps(plant, 0.3); ++i) plant.advance({.steer = 0.0, .throttle = hold.throttle(plant)});
  const int stride = steps(plant, 0.04);
  // Lateral velocity shows both modes; the yaw rate of a car with a C_f = b C_r has only one.
  std::vector<double> w;
  for (int i = 0; i < steps(plant, 1.2); ++i) {
    if (i % stride == 0) w.push_back(plant.state().vy);
    plant.advance({.steer = 0.0, .throttle = hold.throttle(plant)});
  }
  const auto n = static_cast<Eigen::Index>(w.size()) - 2;
  const Eigen::Map<const Eigen::VectorXd> all(w.data(), n + 2);
  Eigen::MatrixX2d before(n, 2);
  before << all.segment(1, n), all.head(n);
  const Eigen::Vector2d found = before.householderQr().solve(all.tail(n));
  const double p = found(0), q = found(1);
  const std::complex<double> root = std::sqrt(std::complex<double>(p * p / 4.0 + q, 0.0));
  const double dt = stride * plant.step_length();
  return {std::log(p / 2.0 + root) / dt, std::log(p / 2.0 - root) / dt};
}

std::pair<double, double> yaw_rise(Plant& plant, double speed, double steer) {
  const double steady = steady_circle(plant, steer, speed).yaw_rate;
  plant.reset({}, speed);
  SpeedHold hold{speed};
  for (int i = 0; i < steps(plant, 3.0); ++i) plant.advance({.steer = 0.0, .throttle = hold.throttle(plant)});
  std::pair<double, double> times{-1.0, -1.0};
  for (int i = 1; i <= steps(plant, 5.0); ++i) {
    plant.advance({.steer = steer, .throttle = hold.throttle(plant)});
    const double share = plant.state().r / steady;
    if (times.first < 0.0 && share >= 0.5) times.first = i * plant.step_length();
    if (times.second < 0.0 && share >= 0.9) times.second = i * plant.step_length();
  }
  return times;
}

Peak peak_cornering(Plant& plant, double speed) {
  plant.reset({}, speed);
  SpeedHold hold{speed};
  Peak peak;
  double smooth = 0.0;
  for (int i = 0; i < steps(plant, 20.0); ++i) {
    const double steer = std::min(0.02 * i * plant.step_length(), 0.4363);
    plant.advance({.steer = steer, .throttle = hold.throttle(plant)});
    smooth += (plant.output().ay - smooth) * plant.step_length() / 0.1;
    if (smooth > peak.lateral_acceleration) peak = {smooth, steer};
    if (plant.output().speed < 0.8 * speed) break;
  }
  return peak;
}

Mismatch compare(Plant& plant, const model::VehicleParams& params, double speed, double lateral) {
  return compare_with(record(plant, params, speed, lateral), params);
}

Identified identify_single_track(Plant& plant, const model::VehicleParams& params) {
  std::vector<Log> logs;
  for (const double speed : {20.0, 30.0, 45.0}) logs.push_back(record(plant, params, speed, 5.0));
  model::VehicleParams trial = params;
  trial.friction = 10.0;  // far from saturation: linear
  Identified best;
  double least = 1e9;
  for (double front = 4.5; front < 6.0; front += 0.05) {
    for (double rear = 4.5; rear < 6.0; rear += 0.05) {
      trial.cornering_front = front;
      trial.cornering_rear = rear;
      double sum = 0.0;
      for (const Log& log : logs) sum += std::pow(compare_with(log, trial).yaw_rate, 2);
      if (sum >= least) continue;
      least = sum;
      best = {front, rear};
    }
  }
  return best;
}

std::pair<std::complex<double>, std::complex<double>> linear_modes(const model::VehicleParams& p,
                                                                   double speed) {
  const double load = p.mass * (p.load_constant + p.load_per_speed * speed) / p.wheelbase();
  const double front = p.cornering_front * load * p.rear_axle;
  const double rear = p.cornering_rear * load * p.front_axle;
  const double a11 = -(front + rear) / (p.mass * speed);
  const double moment = p.front_axle * front - p.rear_axle * rear;
  const double a12 = -moment / (p.mass * speed * speed) - (1.0 - p.steer_helper);
  const double a21 = -moment / p.yaw_inertia;
  const double a22 =
      -(p.front_axle * p.front_axle * front + p.rear_axle * p.rear_axle * rear) / (p.yaw_inertia * speed);
  const double half = 0.5 * (a11 + a22);
  const std::complex<double> root = std::sqrt(std::complex<double>(half * half - a11 * a22 + a12 * a21, 0.0));
  return {half + root, half - root};
}

}  // namespace chicane::sim::experiment
