// SPDX-License-Identifier: MIT
#include "chicane/sim/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "chicane/base/math.hpp"

namespace chicane::sim {

namespace {

constexpr double kJudgementPeriod = 0.005;  // [s]

/// The waypoint nearest to the car; on a road that crosses itself, the one nearest along the road that the
/// car goes along.
int nearest_waypoint(const road::Track& track, const model::Pose& pose) noexcept {
  const auto& points = track.raw_points();
  const road::Path& line = track.centre();
  const Vec2 position{pose.x, pose.y};
  const double s = track.crossings() > 0 ? project_anywhere(track, pose).s : 0.0;
  int nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = track.crossings() > 0 ? std::fabs(line.difference(track.raw_places()[i], s))
                                                  : (points[i].position - position).squared_norm();
    if (distance < least) {
      least = distance;
      nearest = static_cast<int>(i);
    }
  }
  return nearest;
}

}  // namespace

World::World(Plant& plant, const road::Track& track) : plant_{&plant}, judge_{track} {
  // A model car lives faster: the time scale of its size (model/similarity.hpp).
  const auto patches = plant.contact_points();
  const double pace = std::min(std::sqrt(patches[0].x() - patches[2].x()), 1.0);
  steps_per_judgement_ =
      std::max(1, static_cast<int>(std::lround(pace * kJudgementPeriod / plant.step_length())));
  place(track.start_s(), track.start_d());
}

void World::stand_on(Plant& plant, const road::Track& track) noexcept {
  plant_ = &plant;
  judge_.stand_on(track);
}

void World::place(double s, double offset, double speed) noexcept {
  const road::PathPoint point = track().centre().at(s);
  reset({.x = point.position.x() - offset * sin(point.heading),
         .y = point.position.y() + offset * cos(point.heading),
         .psi = point.heading},
        speed);
}

void World::reset(const model::Pose& pose, double speed) noexcept {
  plant_->reset(pose, speed);
  begin_ = 0.0;
  step_count_ = 0;
  judge_.reset(0.0, sighting());
}

void World::reset(const model::State& start) noexcept {
  plant_->reset({.x = start.x, .y = start.y, .psi = start.psi}, start.vx);
  plant_->set_motion({start.vx, start.vy}, start.r);
  begin_ = 0.0;
  step_count_ = 0;
  judge_.reset(0.0, sighting());
}

void World::see(double time, const model::State& car) noexcept {
  plant_->reset({.x = car.x, .y = car.y, .psi = car.psi}, car.vx);
  plant_->set_motion({car.vx, car.vy}, car.r);
  begin_ = time;
  step_count_ = 0;
  judge_.see(time, sighting());
}

void World::put(const model::Pose& pose) noexcept {
  begin_ = time();
  step_count_ = 0;
  plant_->reset(pose, 0.0);
  judge_.reset(begin_, sighting());
}

void World::advance(const model::Command& command) noexcept {
  plant_->advance(command);
  ++step_count_;
  if (step_count_ % steps_per_judgement_ == 0) judge_.see(time(), sighting());
}

Sighting World::sighting() const noexcept {
  const model::State& car = plant_->state();
  return {.pose = {.x = car.x, .y = car.y, .psi = car.psi},
          .speed = plant_->output().speed,
          .contact_points = plant_->contact_points()};
}

int select_waypoints(const road::Track& track, const model::Pose& pose, int count,
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
