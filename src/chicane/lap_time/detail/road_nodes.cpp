// SPDX-License-Identifier: MIT
#include "chicane/lap_time/detail/road_nodes.hpp"

#include <algorithm>
#include <cmath>

#include "chicane/base/angle.hpp"

namespace chicane::lap_time {
namespace {

constexpr double kSample = 1.0;      // of the speeds that decide the spacing [m]
constexpr double kLeastStep = 0.35;  // [m]
constexpr double kMostStep = 4.0;
constexpr double kWindow = 6.0;  // over which the line's curvature is averaged [m]
constexpr double kMostReach = 0.9;

/// Width [m] on the side to which the line bends with `bend` [1/m], if positive: at most kMostReach of the
/// way to the bend's centre. What lies beyond belongs to other places along the line.
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

}  // namespace chicane::lap_time
