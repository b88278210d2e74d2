// SPDX-License-Identifier: MIT
// Identification: table of the estimated numbers, windows of the logs, rounds of fitting, and prediction
// errors.
#include "chicane/identify/identification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <variant>

#include "chicane/base/math.hpp"
#include "chicane/base/option.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/identify/detail/window_fit.hpp"
#include "chicane/model/prediction.hpp"

namespace chicane::identify {
namespace {

// All constants are chosen. Times and speeds are those of a car in full size.
constexpr double kWindow = 5.0;            // [s] length of a window
constexpr double kSeen = 0.5;              // [s] samples from which a prediction starts
constexpr double kLongestAhead = 3.3;      // [s] length of a prediction: errors are given up to 3 s ahead
constexpr double kLeastDriving = 10.0;     // [s] least length of all windows of a fit
constexpr double kLeastSpeed = 3.0;        // [m/s] below it tyres creep and brakes hold
constexpr std::size_t kMostWindows = 400;  // limit of windows in a fit
constexpr std::size_t kFewWindows = 12;    // limit of windows in a rough search
constexpr int kRoughSteps = 12;            // limit of steps of a rough search
constexpr double kRoughAccuracy = 3e-2;    // accuracy of all rounds but the last, in deviations of the prior
constexpr double kAccuracy = 1e-3;         // accuracy of the last round, in deviations of the prior
constexpr double kMoreGrip = 0.4;          // logarithm of the first guess of the friction over its prior

/// Estimated number: its prior, and its place in the car of the fit, which is in full size.
struct Row {
  std::string key;
  Unit unit;
  bool is_log;                            ///< the logarithm is estimated: the number is positive
  double mean;                            ///< mean of the prior, in SI units
  double deviation;                       ///< deviation of the prior, in SI units or of the logarithm
  std::function<void(Car&, double)> put;  ///< stores a value in SI units in a car
  double per_full_size = 1.0;             ///< value for the actual car over the value in full size
  /// Error of the fit that more samples do not reduce, root mean square in the unit of `deviation`; measured
  /// by studies/tables/identification.py --noise 0 and 1: the model lacks effects of the shipped cars'
  /// plants, and the commands answer the noise of the sensors (docs/identification.md, "The method").
  double model_error = 0.0;
};

/// Value for the actual car over the value in full size, of numbers with this unit (model/vehicle.hpp).
double per_full_size(std::string_view unit, const model::Similarity& to) {
  const double length = to.length(), time = to.time();
  if (unit == "ms") return 1.0 / time;
  if (unit == "m") return 1.0 / length;
  if (unit == "kg m²") return 1.0 / (length * length * length * length * length);
  if (unit == "deg/s" || unit == "1/s") return time;
  if (unit == "W/kg") return 1.0 / to.speed();
  if (unit == "1/m") return length;
  return 1.0;  // ratios, angles, accelerations
}

/// Scales the axles of a car to the wheelbase `to` [m].
void scale_wheelbase(Car& car, double to) {
  const double by = to / car.vehicle.wheelbase();
  car.vehicle.front_axle *= by;
  car.vehicle.rear_axle *= by;
  car.vehicle.kinematic_length *= by;
}

/// Stores a value in a member of a car, or in a member of that member.
template <auto... Members>
void put(Car& car, double value) {
  (car.*....*Members) = value;
}

/// Numbers to estimate, in the order of the report. `start`: car in full size. The deviations of the priors
/// are chosen: the range of cars of one kind.
std::vector<Row> rows_for(const model::VehicleParams& start, const Wheels& wheels, bool has_pedal,
                          bool is_centre_of_mass) {
  std::vector<Row> rows{{"latency_ms", unit::kMillisecond, false, 0.1, 0.1, put<&Car::delay>, 1.0, 0.012}};
  // Adds a parameter of the vehicle, if it is above zero; `least`: least mean of the prior.
  const auto add = [&](std::string_view name, double deviation, double least = 0.0, double error = 0.0) {
    const Option& option = *std::ranges::find(model::vehicle_options(), name, &Option::name);
    const double mean = std::max(std::get<double>(option.read(&start)), least);
    if (!(mean > 0.0) || !std::isfinite(mean)) return;
    rows.push_back({option_key("", option), option.unit, true, mean, deviation,
                    [&option](Car& car, double value) { option.write(&car.vehicle, value); }, 1.0, error});
  };
  add("steer_lag", 1.0, 0.02, 0.3);
  rows.push_back({"steer_offset_deg", unit::kDegree, false, 0.0, 0.035, put<&Car::steer_offset>});
  rows.push_back({"wheelbase_m", unit::kMetre, true, start.wheelbase(), 0.2, scale_wheelbase, 1.0, 0.01});
  add("cornering_front", 0.5, 0.0, 0.013);
  add("cornering_rear", 0.5, 0.0, 0.018);
  add("friction", 0.3);
  add("yaw_inertia", 0.3, 0.0, 0.03);
  if (has_four_wheels(start)) {
    rows.push_back({"relaxation_m", unit::kMetre, true, wheels.relaxation, 0.7,
                    put<&Car::wheels, &Wheels::relaxation>, 1.0, 0.2});
    rows.push_back({"load_lag_ms", unit::kMillisecond, true, wheels.load_lag, 1.0,
                    put<&Car::wheels, &Wheels::load_lag>, 1.0, 0.35});
    rows.push_back({"rotating", unit::kNone, true, wheels.rotating, 0.03,
                    put<&Car::wheels, &Wheels::rotating>, 1.0, 0.005});
  }
  add("steer_rate_limit", 1.0, 0.0, 0.3);
  if (!is_centre_of_mass)
    rows.push_back({"reference_m", unit::kMetre, false, 0.0, 0.5 * start.wheelbase(), put<&Car::reference>});
  if (!has_pedal) return rows;
  add("drive_acceleration", 0.5, 0.0, 0.0025);
  add("drive_power_per_mass", 0.5);
  add("brake_acceleration", 0.5, 0.0, 0.004);
  add("drive_lag", 1.0, 0.02, 0.3);
  add("drag_constant", 1.0, 0.0, 0.035);
  for (const std::string_view name : {"drag_linear", "drag_quadratic"}) add(name, 1.0);
  return rows;
}

/// Value in SI units of the estimated `theta`.
double value_of(const Row& row, double theta) { return row.is_log ? exp(theta) : theta; }

/// Prior of all numbers; its car is `start` with the numbers.
Prior prior_of(const std::vector<Row>& rows, const model::VehicleParams& start, const Wheels& wheels) {
  Prior prior;
  for (const Row& row : rows) {
    prior.mean.push_back(row.is_log ? log(row.mean) : row.mean);
    prior.deviation.push_back(row.deviation);
  }
  prior.car = [rows, start, wheels](const std::vector<double>& theta) {
    Car car{.vehicle = start, .wheels = wheels};
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].put(car, value_of(rows[i], theta[i]));
    car.delay = std::max(0.0, car.delay);
    return car;
  };
  return prior;
}

/// Adds windows of up to `length` [s] in which the car does not stand, between two times of a log. Their
/// starts are taken from the samples.
void add_windows(const std::vector<DriveLog>& logs, std::size_t log, double from, double to, double length,
                 std::vector<Window>& windows) {
  const std::vector<Sample>& samples = logs[log].samples;
  std::size_t first = 0;
  while (first < samples.size() && samples[first].time < from) ++first;
  while (first < samples.size()) {
    std::size_t last = first;
    while (last < samples.size() && samples[last].time < std::min(samples[first].time + length, to) &&
           samples[last].speed > kLeastSpeed)
      ++last;
    if (last > first + 8 && samples[last - 1].time - samples[first].time > 0.6 * length) {
      const Sample& at = samples[first];
      const Sample& next = samples[first + 4];
      const double r = (next.psi - at.psi) / (next.time - at.time);
      windows.push_back({log, first, last, {at.x, at.y, at.psi, at.speed, 0.0, r}});
    }
    if (last < samples.size() && samples[last].time >= to) return;
    first = std::max(last, first + 1);
  }
}

/// Sample and prediction of it, scaled from full size to the actual car.
Compared compared(const Sample& seen, const Expected& e, const model::Similarity& from) {
  const double l = from.length(), v = from.speed(), t = seen.time / from.time();
  return {t, seen.x / l, seen.y / l, seen.psi, seen.speed / v, e[0] / l, e[1] / l, e[2], e[3] / v};
}

/// Evaluates the fitted windows with the estimated car: predictions of the samples, and use of the tyres.
void evaluate_fit(const std::vector<DriveLog>& logs, const std::vector<Window>& windows, const Car& car,
                  const model::Similarity& similarity, Identification& found) {
  const model::PredictionModel model(car.vehicle);
  std::array<std::vector<double>, 2> uses;
  std::vector<Expected> expected;
  const std::vector<Actuators> actuators = actuators_of(logs, car);
  for (const Window& window : windows) {
    drive(car, logs[window.log], actuators[window.log], window.first, window.last, window.start, expected);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const Expected& e = expected[i];
      const auto use = model.tire_use(model::BodyMotion<double>{e[5], e[6], e[4], e[7], 0.0});
      uses[0].push_back(use.front);
      uses[1].push_back(use.rear);
      found.fitted.push_back(compared(logs[window.log].samples[window.first + i], e, similarity));
    }
  }
  // 99th percentile of the use of an axle; fills its histogram.
  const auto most_of = [](std::vector<double>& axle, std::array<int, 30>& bins) {
    if (axle.empty()) return 0.0;
    for (const double use : axle)
      ++bins[std::min(bins.size() - 1, static_cast<std::size_t>(std::max(0.0, use / SlipCover::kBin)))];
    const auto at = axle.begin() + static_cast<std::ptrdiff_t>(axle.size() * 99 / 100);
    std::nth_element(axle.begin(), at, axle.end());
    return *at;
  };
  found.use_front = most_of(uses[0], found.slip.front);
  found.use_rear = most_of(uses[1], found.slip.rear);
}

/// Predicts the held-out windows from their first samples.
std::vector<PredictedStretch> predict(const std::vector<DriveLog>& logs, std::vector<Window> windows,
                                      const Car& car, const Noise& noise,
                                      const model::Similarity& similarity) {
  std::vector<PredictedStretch> stretches;
  const std::vector<Actuators> actuators = actuators_of(logs, car);
  std::vector<Expected> expected;
  for (Window& window : windows) {
    const std::vector<Sample>& samples = logs[window.log].samples;
    std::size_t seen = window.first;
    while (seen < window.last && samples[seen].time < samples[window.first].time + kSeen) ++seen;
    fit_start(logs, window, seen, car, actuators[window.log], noise);
    drive(car, logs[window.log], actuators[window.log], window.first, window.last, window.start, expected);
    PredictedStretch stretch{.known = samples[seen - 1].time / similarity.time(), .samples = {}};
    for (std::size_t i = 0; i < expected.size(); ++i)
      stretch.samples.push_back(compared(samples[window.first + i], expected[i], similarity));
    stretches.push_back(std::move(stretch));
  }
  return stretches;
}

/// Pose at the time of `at` of a car that keeps the speed and the mean yaw rate of the known samples.
Compared kept_motion(const PredictedStretch& stretch, const Compared& at) {
  const Compared& first = stretch.samples.front();
  const Compared* last = &first;
  for (const Compared& each : stretch.samples)
    if (each.time <= stretch.known) last = &each;
  const double rate = (last->psi - first.psi) / std::max(last->time - first.time, 1e-9);
  const double ahead = at.time - last->time;
  const double half_turn = 0.5 * rate * ahead;
  const double middle = last->psi + half_turn;
  const double chord = last->speed * ahead * (std::fabs(half_turn) > 1e-6 ? sin(half_turn) / half_turn : 1.0);
  return {.model_x = last->x + chord * cos(middle),
          .model_y = last->y + chord * sin(middle),
          .model_psi = last->psi + rate * ahead};
}

/// Root mean square errors of predictions one, two and three seconds ahead; `to_full_size`: of times.
std::vector<PredictionError> prediction_errors(const std::vector<PredictedStretch>& stretches,
                                               double to_full_size) {
  std::vector<PredictionError> found;
  for (const double seconds : {1.0, 2.0, 3.0}) {
    const double ahead = seconds / to_full_size;
    PredictionError sum{.ahead = ahead};
    int count = 0;
    for (const PredictedStretch& stretch : stretches) {
      const auto at = std::find_if(stretch.samples.begin(), stretch.samples.end(),
                                   [&](const Compared& each) { return each.time >= stretch.known + ahead; });
      if (at == stretch.samples.end()) continue;
      sum.position += Vec2{at->model_x - at->x, at->model_y - at->y}.squared_norm();
      sum.yaw += (at->model_psi - at->psi) * (at->model_psi - at->psi);
      sum.speed += (at->model_speed - at->speed) * (at->model_speed - at->speed);
      const Compared kept = kept_motion(stretch, *at);
      sum.kept_position += Vec2{kept.model_x - at->x, kept.model_y - at->y}.squared_norm();
      sum.kept_yaw += (kept.model_psi - at->psi) * (kept.model_psi - at->psi);
      ++count;
    }
    if (count == 0) continue;
    const auto mean = [&](double squares) { return std::sqrt(squares / count); };
    found.push_back({ahead, mean(sum.position), mean(sum.yaw), mean(sum.speed), mean(sum.kept_position),
                     mean(sum.kept_yaw)});
  }
  return found;
}

/// Keeps every other window until there are few enough.
void thin(std::vector<Window>& windows, std::size_t most) {
  while (windows.size() > most) {
    std::size_t number = 0;
    std::erase_if(windows, [&](const Window&) { return number++ % 2 == 1; });
  }
}

/// Task of a fit, in full size: stretches of logs, numbers to estimate from them, and noise.
struct Task {
  const std::vector<DriveLog>& logs;
  const IdentifyOptions& options;
  std::vector<Window> windows{}, held_out{};  ///< windows to fit, and windows to predict
  std::vector<Row> rows{};                    ///< numbers to estimate
  Prior prior{};
  Noise noise{0.055, 0.055, 0.005, 0.1, 0.02};  ///< first guess; chosen. Each round of the fit replaces it
};

/// Fits the windows in rounds. Each round has the residuals of the round before as noise.
WindowFit fit_in_rounds(Task& task) {
  const bool is_rough = task.options.is_rough;
  const Noise least{1e-3, 1e-3, 2e-4, 5e-3, 1e-3};  // noise of perfect logs; chosen
  // The first round fixes the rate limit of the steering at a high value: a limit that is too low makes every
  // bend wrong, a limit that is too high changes nothing.
  Prior first = task.prior;
  WindowFit fit;
  fit.theta = first.mean;
  for (std::size_t i = 0; i < task.rows.size(); ++i) {
    // Too little grip makes the model spin, and no step helps; too much only makes it slip less.
    if (task.rows[i].key == "friction") fit.theta[i] += kMoreGrip;
    if (task.rows[i].key != "steer_rate_limit_degps") continue;
    fit.theta[i] = first.mean[i] += 1.5;  // logarithm: 4.5 times the rate of the prior; chosen
    first.deviation[i] = 0.01;            // practically fixed
  }
  const int rounds = is_rough ? 1 : 3;
  bool goes_on = true;
  int round = 0;
  for (; round < rounds && goes_on; ++round) {
    int step = 0;
    const auto search = [&](std::vector<Window>& starts, const std::vector<double>& from) {
      return fit_windows(task.logs, starts, round == 0 ? first : task.prior, from, task.noise,
                         round + 1 < rounds ? kRoughAccuracy : kAccuracy, [&] {
                           goes_on = task.options.progress((round + std::min(1.0, 0.07 * step)) /
                                                           rounds);  // some 14 steps a round
                           return goes_on && (step++ < kRoughSteps || !is_rough);
                         });
    };
    // In the first round the steering lag absorbs the effect of the rate limit. So the second round also
    // starts from the prior of the steering, and keeps the better fit.
    std::vector<Window> others = task.windows;
    std::vector<double> other = fit.theta;
    for (std::size_t i = 0; i < task.rows.size(); ++i)
      if (task.rows[i].key.starts_with("steer_") || task.rows[i].key == "latency_ms")
        other[i] = task.prior.mean[i];
    fit = search(task.windows, fit.theta);
    if (WindowFit again; round == 1 && goes_on && (again = search(others, other)).loss < fit.loss) {
      fit = std::move(again);
      task.windows = std::move(others);
    }
    // Both directions of the position have one deviation.
    fit.residual[0] = fit.residual[1] = std::max(fit.residual[0], fit.residual[1]);
    for (std::size_t kind = 0; kind < least.size(); ++kind)
      task.noise[kind] = std::max(fit.residual[kind], least[kind]);
  }
  for (std::size_t i = 0; i < first.mean.size() && round < 2 && !goes_on; ++i) {
    if (first.deviation[i] == task.prior.deviation[i]) continue;  // others were fixed: not estimated
    fit.theta[i] = task.prior.mean[i];
    fit.deviation[i] = task.prior.deviation[i];
  }
  return fit;
}

/// Adds the estimates for the actual car, with intervals of two standard deviations.
void add_estimates(const Task& task, const WindowFit& fit, Identification& found) {
  for (std::size_t i = 0; i < task.rows.size(); ++i) {
    const Row& row = task.rows[i];
    const double deviation = hypot(fit.deviation[i], row.model_error);
    const auto outside = [&](double theta) {
      return row.unit.from_si(value_of(row, theta) * row.per_full_size);
    };
    found.estimates.push_back({row.key, std::string(row.unit.name), outside(fit.theta[i]),
                               outside(fit.theta[i] - 2.0 * deviation),
                               outside(fit.theta[i] + 2.0 * deviation), outside(task.prior.mean[i]),
                               deviation < 0.4 * task.prior.deviation[i]});
    Estimate& each = found.estimates.back();
    if (each.key == "latency_ms")
      for (double* number : {&each.value, &each.low, &each.high}) *number = std::max(0.0, *number);
    // The first part of the curve of the force says little about its peak.
    if (each.key == "friction" && !found.knows_tires()) each.is_excited = false;
  }
}

/// Identifies a car in full size; `logs` are in full size, `configured` is the car in its own size.
Result<Identification> identify_full_size(const std::vector<DriveLog>& logs,
                                          const model::VehicleParams& configured,
                                          const IdentifyOptions& options) {
  const model::Similarity similarity(configured);
  const model::VehicleParams start = similarity.full_size(configured);
  Wheels wheels = options.wheels;
  wheels.relaxation *= similarity.length();
  wheels.load_lag *= similarity.time();
  Task task{.logs = logs, .options = options};
  Identification found;
  bool is_centre_of_mass = true;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const double from = logs[i].samples.front().time, to = logs[i].samples.back().time;
    const double split = to - options.hold_out * (to - from);
    add_windows(logs, i, from, split, kWindow, task.windows);
    add_windows(logs, i, split, to, kSeen + kLongestAhead, task.held_out);
    found.driven += (to - from) / similarity.time();
    found.has_pedal = found.has_pedal && logs[i].has_throttle();
    is_centre_of_mass = is_centre_of_mass && logs[i].is_centre_of_mass;
  }
  const double to_fit = static_cast<double>(task.windows.size()) * kWindow;
  thin(task.windows, options.is_rough ? kFewWindows : kMostWindows);
  if (to_fit < kLeastDriving)
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("logs: got {:.0f} s of driving to fit, expected at least {:.3g} s",
                            to_fit / similarity.time(), kLeastDriving / similarity.time()));
  task.rows = rows_for(start, wheels, found.has_pedal, is_centre_of_mass);
  for (Row& row : task.rows) row.per_full_size = per_full_size(row.unit.name, similarity);
  task.prior = prior_of(task.rows, start, wheels);
  WindowFit fit = fit_in_rounds(task);

  const Car car = task.prior.car(fit.theta);
  Car own_size{.vehicle = configured, .wheels = options.wheels};
  for (std::size_t i = 0; i < task.rows.size(); ++i)
    task.rows[i].put(own_size, task.rows[i].per_full_size * value_of(task.rows[i], fit.theta[i]));
  found.vehicle = own_size.vehicle;
  found.delay = std::max(0.0, own_size.delay);
  found.wheels = own_size.wheels;
  found.loss = fit.loss;
  found.correlation = fit.correlation;
  found.residual = {fit.residual[0] / similarity.length(), fit.residual[2],
                    fit.residual[3] / similarity.speed()};
  evaluate_fit(logs, task.windows, car, similarity, found);
  add_estimates(task, fit, found);
  found.correlations = std::move(fit.correlations);
  found.stretches = predict(logs, std::move(task.held_out), car, task.noise, similarity);
  found.held_out = prediction_errors(found.stretches, similarity.time());
  return found;
}

}  // namespace

double turning_wheelbase(const std::vector<DriveLog>& logs) {
  // All constants are chosen.
  constexpr double kLate = 0.15;        // [s] usual delay and lag of the steering
  constexpr double kSpan = 0.2;         // [s] time over which the yaw rate is taken
  constexpr double kLeastSteer = 0.03;  // [rad] least steering angle of a bend
  constexpr double kSlowest = 0.3;      // [m/s] least speed
  constexpr std::size_t kFewest = 20;   // least number of samples in bends
  // Least squares of steer = wheelbase · curvature + understeer · sideways acceleration: sums of products of
  // c, a, s.
  double cc = 0.0, ca = 0.0, aa = 0.0, cs = 0.0, as = 0.0;
  std::size_t count = 0;
  for (const DriveLog& log : logs) {
    std::size_t command = 0, ahead = 0;
    for (const Sample& at : log.samples) {
      while (ahead + 1 < log.samples.size() && log.samples[ahead].time < at.time + kSpan) ++ahead;
      const Sample& next = log.samples[ahead];
      const double middle = 0.5 * (at.time + next.time);
      while (command + 1 < log.commands.size() && log.commands[command + 1].time <= middle - kLate) ++command;
      const double steer = log.commands[command].steer;
      if (next.time - at.time < 0.5 * kSpan || std::fabs(steer) < kLeastSteer) continue;
      const double yaw_rate = (next.psi - at.psi) / (next.time - at.time);
      const double speed = 0.5 * (at.speed + next.speed);
      if (!(yaw_rate * steer > 0.0 && speed > kSlowest)) continue;
      const double curvature = yaw_rate / speed, sideways = speed * yaw_rate;
      cc += curvature * curvature;
      ca += curvature * sideways;
      aa += sideways * sideways;
      cs += curvature * steer;
      as += sideways * steer;
      ++count;
    }
  }
  const double wheelbase = (cs * aa - as * ca) / (cc * aa - ca * ca);
  return count >= kFewest && wheelbase > 0.0 ? wheelbase : std::numeric_limits<double>::quiet_NaN();
}

std::array<double, 2> Identification::worst_prediction() const noexcept {
  constexpr double kResiduals = 6.0;
  const PredictionError& error = held_out.front();
  return {std::max(std::min(error.kept_position, kResiduals * residual[0]), 0.1),
          std::max(std::min(error.kept_yaw, kResiduals * residual[1]), kPi / 180.0)};
}

bool Identification::predicts() const noexcept {
  return held_out.empty() || (held_out.front().position <= worst_prediction()[0] &&
                              held_out.front().yaw <= worst_prediction()[1]);
}

bool Identification::knows_tires() const noexcept {
  return std::max(use_front, use_rear) >= kRaceUse && std::min(use_front, use_rear) >= kLeastRaceUse;
}

double Identification::least_friction() const noexcept {
  if (!knows_tires()) return 0.0;
  for (const Estimate& each : estimates)
    if (each.key == "friction") return std::max(0.0, each.low);
  return 0.0;
}

double Identification::shown_friction() const noexcept {
  const double use = std::min(1.0, std::min(use_front, use_rear));
  const double shape = vehicle.tire_shape;
  // Force over slip by the curve of the tyre; by its chord for the curve of the original simulator.
  const double force = shape > 1.0 ? sin(shape * atan(use * tan(kPi / (2.0 * shape)))) : use;
  return force * vehicle.friction;
}

Result<Identification> identify(const std::vector<DriveLog>& logs, const model::VehicleParams& start,
                                const IdentifyOptions& options) {
  // A model car is fitted in full size, as controllers treat it, because the bounds of the model are for full
  // size.
  const model::Similarity similarity(start);
  std::vector<DriveLog> scaled = logs;
  for (DriveLog& log : scaled) {
    for (Sample& sample : log.samples) {
      sample.time *= similarity.time();
      sample.x *= similarity.length();
      sample.y *= similarity.length();
      sample.speed *= similarity.speed();
      sample.yaw_rate /= similarity.time();
    }
    for (SentCommand& command : log.commands) command.time *= similarity.time();
  }
  return identify_full_size(scaled, start, options);
}

}  // namespace chicane::identify
