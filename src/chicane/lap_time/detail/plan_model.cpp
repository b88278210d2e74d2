// SPDX-License-Identifier: MIT
// Road at the nodes of a plan, first guess of speeds, and the check that a car's width and lock fit the road.
#include "chicane/lap_time/detail/plan_model.hpp"

#include <cmath>
#include <concepts>
#include <cstdio>
#include <string>
#include <utility>

namespace chicane::lap_time {
namespace {

constexpr double kSample = 1.0;      // [m] between the speeds that choose the nodes; chosen
constexpr double kLeastStep = 0.35;  // [m] least step between nodes; chosen
constexpr double kMostStep = 4.0;    // [m] largest step between nodes; chosen
constexpr double kWindow = 6.0;      // [m] length over which the line's curvature is averaged; chosen
constexpr double kMostReach = 0.9;   // used width over the distance to the bend's centre; chosen

/// Width of the road that a place of the line may use on one side [m]. `bend`: curvature of the line towards
/// that side [1/m]. Limited to kMostReach of the way to the bend's centre, because points beyond the centre
/// belong to other places along the line.
double reach(double width, double bend) {
  constexpr double kStraight = 1e-6;  // [1/m]
  return std::min(width, kMostReach / std::max(bend, kStraight));
}

}  // namespace

std::vector<double> guess_speeds(const std::vector<double>& curvature, const std::vector<double>& step,
                                 const GuessCar& car) {
  const std::size_t n = curvature.size();
  std::vector<double> v(n);
  for (std::size_t k = 0; k < n; ++k)
    v[k] = std::min(car.speed, std::sqrt(car.grip / std::max(std::fabs(curvature[k]), 1e-4)));
  for (std::size_t i = 2 * n; i-- > 0;) {
    const std::size_t k = i % n;
    const double next = v[(k + 1) % n];
    v[k] = std::min(v[k], std::sqrt(next * next + 2.0 * car.brake * step[k]));
  }
  for (std::size_t i = 0; i < 2 * n; ++i) {
    const std::size_t k = i % n;
    double& next = v[(k + 1) % n];
    next = std::min(next, std::sqrt(v[k] * v[k] + 2.0 * car.drive * step[k]));
  }
  return v;
}

RoadNodes lay_nodes(const road::Track& track, const GuessCar& car, double time_step) {
  const road::Path& line = track.centre();
  const double length = track.length();
  const auto samples = static_cast<std::size_t>(std::max(16.0, std::ceil(length / kSample)));
  const double sample = length / static_cast<double>(samples);
  const auto mean_bend = [&](double s, double window) {
    return (line.at(s + 0.5 * window).heading - line.at(s - 0.5 * window).heading) / window;
  };
  std::vector<double> bend(samples);
  for (std::size_t i = 0; i < samples; ++i) bend[i] = mean_bend(static_cast<double>(i) * sample, kWindow);
  const std::vector<double> speed = guess_speeds(bend, std::vector<double>(samples, sample), car);

  // Nodes at equal values of the integral of 1 / step.
  std::vector<double> count(samples + 1, 0.0);
  for (std::size_t i = 0; i < samples; ++i)
    count[i + 1] = count[i] + sample / std::clamp(time_step * speed[i], kLeastStep, kMostStep);
  const auto n = static_cast<std::size_t>(std::max(12.0, std::ceil(count.back())));
  RoadNodes road;
  for (std::size_t k = 0, i = 0; k < n; ++k) {
    const double wanted = count.back() * static_cast<double>(k) / static_cast<double>(n);
    while (i + 1 < samples && count[i + 1] <= wanted) ++i;
    road.s.push_back(sample * (static_cast<double>(i) + (wanted - count[i]) / (count[i + 1] - count[i])));
  }
  for (std::size_t k = 0; k < n; ++k) {
    const double s = road.s[k];
    const double next = k + 1 < n ? road.s[k + 1] : length;
    const double last = k > 0 ? road.s[k - 1] : road.s[n - 1] - length;
    road.heading.push_back(wrap_angle(line.at(s).heading));
    road.step.push_back(next - s);
    road.turn.push_back(line.at(next).heading - line.at(s).heading);
    road.curvature.push_back(mean_bend(0.5 * (s + 0.5 * (next + last)), 0.5 * (next - last)));
    const double kerb = track.kerb_width();
    const double a = car.front_axle;
    const double b = car.rear_axle;
    road.front_bend.push_back(mean_bend(s + a / 3.0, 2.0 * a / 3.0));
    road.rear_bend.push_back(mean_bend(s - b / 3.0, 2.0 * b / 3.0));
    const double here = road.curvature.back();
    const double front = road.front_bend.back();
    const double rear = road.rear_bend.back();
    road.front_left.push_back(reach(track.left_width(s + a) + kerb, std::max(here, front)));
    road.front_right.push_back(reach(track.right_width(s + a) + kerb, std::max(-here, -front)));
    road.rear_left.push_back(reach(track.left_width(s - b) + kerb, std::max(here, rear)));
    road.rear_right.push_back(reach(track.right_width(s - b) + kerb, std::max(-here, -rear)));
  }
  return road;
}

/// Numbers in the text of an error: `format` has a %f, %e or %g for each of them.
[[nodiscard]] std::string message(const char* format, std::same_as<double> auto... values) {
  std::array<char, 320> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, values...);
  return buffer.data();
}

namespace {

/// Problem of a line whose largest curvature is as small as the road allows: least Σ (κ/κ_lock)⁸. Variables:
/// offset, course against the road, curvature; change of curvature along the road.
struct BendModel {
  static constexpr int kVariables = 4, kStates = 3, kEquations = 0, kInequalities = 4;
  static constexpr std::array<double, kVariables> scale() { return {2.0, 0.2, 0.1, 0.1}; }

  CarSize car;
  const RoadNodes* road = nullptr;

  template <class T>
  void functions(std::size_t k, const T* z, T* out) const {
    const RoadNodes& at = *road;
    const T heading = z[1] - car.rear_axle * z[2];  // the rear axle follows without slip
    const T length = (1.0 - at.curvature[k] * z[0]) / cos(z[1]);
    const T share = (1.0 / car.most_curvature()) * z[2];
    const T square = share * share;
    const T fourth = square * square;
    *out++ = sin(z[1]) * length;
    *out++ = z[2] * length;
    *out++ = z[3] * length;
    *out++ = (fourth * fourth + kSmooth * (z[3] * z[3])) * length;
    OnRoad<T>(0.0, z[0], heading, T(1.0), T(0.0)).edge_gaps(at, k, z[0], car, 0.0, out);
  }

 private:
  static constexpr double kSmooth = 1e-3;  // weight of the squared change of curvature; chosen
};

constexpr double kPace = 4.0;       // [m/s] speed that chooses the nodes; chosen
constexpr double kFollowed = 1e-3;  // scaled violation of a line that stays on the road: millimetres
constexpr int kNarrowings = 3;      // times that the room is halved; chosen

/// Checks that the car's lock suffices for the straightest line with its centre of mass at most `beside` [m]
/// from the middle. `has_answer` becomes false if the search ended without a line.
Result<void> bends_fit(RoadNodes road, const CarSize& car, const Fit& fit, double beside, bool& has_answer) {
  for (std::vector<double>* room : {&road.front_left, &road.front_right, &road.rear_left, &road.rear_right}) {
    for (double& each : *room) each = std::min(each, beside + car.half_width);
  }
  BendModel model;
  model.car = car;
  model.road = &road;
  const ModelFunctions<BendModel> functions(model);
  const std::size_t n = road.s.size();
  std::vector<double> z(n * BendModel::kVariables, 0.0);
  std::vector<double> changes(n * BendModel::kStates, 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    z[k * BendModel::kVariables + 2] = road.curvature[k];
    changes[k * BendModel::kStates + 1] = -road.turn[k];
  }
  Collocation problem(functions, road.step, std::move(changes));
  const auto curvature = [&](std::size_t k) { return std::fabs(z[k * BendModel::kVariables + 2]); };
  std::size_t worst = 0;
  const auto can_be_followed = [&] {
    worst = 0;
    for (std::size_t k = 0; k < n; ++k)
      if (curvature(k) > curvature(worst)) worst = k;
    return fit.reserve * curvature(worst) <= car.most_curvature();
  };
  Collocation::Options options{.tolerance = 1e-4,
                               .first_barrier = 0.1,
                               .last_barrier = 1e-5,
                               .cost_scale = 1.0,
                               .most_iterations = 300};
  if (fit.go_on) options.go_on = [&](int, double, double) { return fit.go_on(); };
  // One line that the car can follow is enough; the straightest of all takes ten times as long.
  options.is_enough = [&](const std::vector<double>&, double violation) {
    return violation <= kFollowed && can_be_followed();
  };
  const Collocation::Report report = problem.solve(z, options);
  has_answer = !report.is_stopped && report.violation <= 1e-2;
  if (!has_answer || can_be_followed()) return {};
  return fail(
      ErrorCode::kInvalidArgument,
      message("limit: the bend at s = %.1f m leaves room for a radius of %.2f m, and the car's full lock "
              "drives no less than %.2f m",
              fit.scale * road.s[worst], fit.scale / curvature(worst), fit.scale / car.most_curvature()) +
          (fit.reserve > 1.0 ? ", of which something must be left to steer by" : ""));
}

}  // namespace

double CarSize::most_curvature() const noexcept {
  const double rear = chicane::tan(steer_limit) / (front_axle + rear_axle);  // at the rear axle's middle
  return rear / std::sqrt(1.0 + rear_axle * rear_axle * rear * rear);
}

Result<void> fits_road(const road::Track& track, const CarSize& car, const Fit& fit) {
  const GuessCar pace{.grip = 2.0,
                      .drive = 2.0,
                      .brake = 2.0,
                      .speed = kPace,
                      .front_axle = car.front_axle,
                      .rear_axle = car.rear_axle};
  const RoadNodes road = lay_nodes(track, pace, 0.25);
  double sharpest = 0.0;
  double widest = 0.0;
  for (std::size_t k = 0; k < road.s.size(); ++k) {
    const double most = fit.beside + car.half_width;
    const double front = std::min(road.front_left[k], most) + std::min(road.front_right[k], most);
    const double rear = std::min(road.rear_left[k], most) + std::min(road.rear_right[k], most);
    const double width = std::min(front, rear);
    if (width <= 2.0 * car.half_width)
      return fail(ErrorCode::kInvalidArgument,
                  message("limit: the road is %.2f m wide at s = %.1f m, expected more than the car's %.2f m",
                          fit.scale * width, fit.scale * road.s[k], fit.scale * 2.0 * car.half_width));
    widest = std::max(widest, width);
    sharpest = std::max(sharpest, std::fabs(road.curvature[k]));
  }
  if (sharpest * fit.surely < car.most_curvature()) return {};

  // Any closed line is at least as long as the circle of its tightest radius.
  double turned = 0.0;
  for (std::size_t k = 0; k < road.s.size(); ++k) turned += std::fabs(road.turn[k]);
  const double longest = track.length() + (widest - 2.0 * car.half_width) * turned;
  const double circle = 2.0 * kPi / car.most_curvature();
  if (track.centre().is_closed() && longest < circle)
    return fail(
        ErrorCode::kInvalidArgument,
        message("limit: the loop is %.1f m long, expected more than the car's circle at full lock, %.1f m",
                fit.scale * track.length(), fit.scale * circle));

  // If the search fails, it is repeated on narrower roads. On a road wider than the radius of its bends the
  // search for the straightest line can end in a fold of the coordinates, and a line on the narrower road is
  // valid on the wider one.
  bool has_answer = false;
  Result<void> fits = bends_fit(road, car, fit, fit.beside, has_answer);
  double beside = std::min(fit.beside, widest);
  for (int narrowing = 0; narrowing < kNarrowings && !fits; ++narrowing) {
    beside *= 0.5;
    if (bends_fit(road, car, fit, beside, has_answer) && has_answer) return {};
  }
  return fits;
}

}  // namespace chicane::lap_time
