// SPDX-License-Identifier: MIT
#include "chicane/sim/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "chicane/base/angle.hpp"
#include "chicane/base/math.hpp"

namespace chicane::sim {

namespace {

constexpr double kJudgementPeriod = 0.005;  // [s]

/// The waypoint nearest to the car. On a road that crosses itself one of the other road may be nearer than
/// the next one of its own: there an angle between the car and the way on costs as much as kTurnCost spacings
/// a radian, among the waypoints that are at most one spacing farther than the nearest.
int nearest_waypoint(const path::Track& track, const model::Pose& pose) noexcept {
  constexpr double kTurnCost = 2.0;
  const auto& points = track.raw_points();
  const int size = static_cast<int>(points.size());
  const Vec2 position{pose.x, pose.y};
  const auto point = [&](int i) -> const Vec2& { return points[static_cast<std::size_t>(i)].position; };
  int nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < size; ++i) {
    const double squared = (point(i) - position).squared_norm();
    if (squared < least) {
      least = squared;
      nearest = i;
    }
  }
  if (track.crossings() == 0) return nearest;
  const double spacing = track.length() / size;
  const double most = std::sqrt(least) + spacing;
  double cheapest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < size; ++i) {
    const double distance = (point(i) - position).norm();
    if (distance > most) continue;
    const Vec2 along = point((i + 1) % size) - point((i + size - 1) % size);
    const double turn = std::fabs(angle_difference(atan2(along.y(), along.x()), pose.psi));
    const double cost = distance + kTurnCost * spacing * turn;
    if (cost < cheapest) {
      cheapest = cost;
      nearest = i;
    }
  }
  return nearest;
}

}  // namespace

World::World(Plant& plant, const path::Track& track) noexcept : plant_{plant}, judge_{track} {
  // A model car lives faster: the time scale of its size (model/similarity.hpp).
  const auto patches = plant.contact_points();
  const double pace = std::min(std::sqrt(patches[0].x() - patches[2].x()), 1.0);
  steps_per_judgement_ =
      std::max(1, static_cast<int>(std::lround(pace * kJudgementPeriod / plant.step_length())));
  place(track.start_s(), track.start_d());
}

void World::place(double s, double offset, double speed) noexcept {
  const path::PathPoint point = track().centre().at(s);
  reset({.x = point.position.x() - offset * sin(point.heading),
         .y = point.position.y() + offset * cos(point.heading),
         .psi = point.heading},
        speed);
}

void World::reset(const model::Pose& pose, double speed) noexcept {
  plant_.reset(pose, speed);
  step_count_ = 0;
  judge_.reset(0.0, sighting());
}

void World::reset(const model::State& start) noexcept {
  plant_.reset({.x = start.x, .y = start.y, .psi = start.psi}, start.vx);
  plant_.set_motion({start.vx, start.vy}, start.r);
  step_count_ = 0;
  judge_.reset(0.0, sighting());
}

void World::advance(const model::Command& command) noexcept {
  plant_.advance(command);
  ++step_count_;
  if (step_count_ % steps_per_judgement_ == 0) judge_.see(time(), sighting());
}

Sighting World::sighting() const noexcept {
  const model::State& car = plant_.state();
  return {.pose = {.x = car.x, .y = car.y, .psi = car.psi},
          .speed = plant_.output().speed,
          .contact_points = plant_.contact_points()};
}

int select_waypoints(const path::Track& track, const model::Pose& pose, int count,
                     model::Measurement& measurement) noexcept {
  const auto& points = track.raw_points();
  const int size = static_cast<int>(points.size());
  const bool is_closed = track.centre().is_closed();
  const Vec2 position{pose.x, pose.y};
  measurement.waypoint_count = 0;
  if (size == 0) return 0;
  int next = nearest_waypoint(track, pose);
  const Vec2 direction{cos(pose.psi), sin(pose.psi)};
  if ((points[static_cast<std::size_t>(next)].position - position).dot(direction) < 0.0) ++next;
  int first = next - 1;
  if (!is_closed) first = std::clamp(first, 0, size - 1);
  const int shown = std::clamp(std::min(count, size), 0, model::Measurement::kMaxWaypoints);
  for (int i = 0; i < shown; ++i) {
    if (!is_closed && first + i >= size) break;
    const auto index = static_cast<std::size_t>((first + i + size) % size);
    measurement.waypoints[static_cast<std::size_t>(i)] = points[index].position;
    measurement.waypoint_count = i + 1;
  }
  return measurement.waypoint_count;
}

}  // namespace chicane::sim
