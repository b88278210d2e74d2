// SPDX-License-Identifier: MIT
// Judge and world: edge distances, off-track events, laps, sectors and corners of a car on its track.
#include "chicane/sim/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "chicane/base/math.hpp"

namespace chicane::sim {
namespace {

// Distances are for cars in full size; chosen, as is all else.
constexpr double kSearch = 6.0;             // [m] reach of a local projection
constexpr double kLost = 8.0;               // [m] distance off the road at which the whole line is searched
constexpr int kLostPatience = 10;           // sightings between two such searches
constexpr double kCoveredShare = 0.95;      // share of the line that a lap must cover
constexpr double kBackOnTrack = 0.05;       // [m] edge distance that ends an off-track event
constexpr double kBackOnTrackTime = 0.2;    // [s] time for which that distance must hold
constexpr double kFullSize = 1.5;           // [m] wheelbase from which on a car is in full size
constexpr double kJudgementPeriod = 0.005;  // [s] time between two sightings of the plant

/// Size of a car over full size, at most 1.
double size_of(const Sighting& car) noexcept {
  const double wheelbase = car.contact_points[0].x() - car.contact_points[2].x();
  return wheelbase > 0.0 ? std::min(wheelbase / kFullSize, 1.0) : 1.0;
}

}  // namespace

road::Projection project_anywhere(const road::Track& track, const model::Pose& car) noexcept {
  const road::Path& line = track.centre();
  const double s = line.project({car.x, car.y}).s;
  return line.project_along({car.x, car.y}, car.psi, 0.5 * (track.left_width(s) + track.right_width(s)));
}

Judge::Judge(const road::Track& track)
    : track_{&track},
      lap_length_{track.lap_length()},
      corners_{road::corners_of(track)},
      corner_ends_{road::corner_sectors(track, corners_)},
      corner_times_(corners_.size()),
      last_corner_times_(corners_.size()) {}

void Judge::reset(double time, const Sighting& car) noexcept {
  covered_ = off_track_at_lap_start_ = back_on_track_ = 0.0;
  lap_start_ = sector_start_ = corner_start_ = time;
  corner_ = 0;
  std::fill(last_corner_times_.begin(), last_corner_times_.end(), 0.0);
  lost_for_ = 0;
  state_ = {};
  size_ = size_of(car);
  state_.time = time;
  // A car on the start line is timed at once; any other drives to the line first.
  constexpr double kOnTheLine = 1.0;  // [m] distance of a car on the start line
  const road::Path& line = track_->centre();
  state_.s = project_anywhere(*track_, car.pose).s;
  state_.progress = line.difference(state_.s, track_->start_s());
  state_.is_timed = std::fabs(state_.progress) <= kOnTheLine * size_;
  if (line.is_closed() && state_.progress > kOnTheLine * size_) state_.progress -= lap_length_;
  next_line_ = state_.is_timed || state_.progress > kOnTheLine * size_ ? lap_length_ : 0.0;
  locate(0.0, car);
  state_.min_edge_distance = std::numeric_limits<double>::infinity();
  measure_edges(0.0, car);
}

void Judge::see(double time, const Sighting& car) noexcept {
  const double elapsed = time - state_.time;
  const double progress_before = state_.progress;
  state_.time = time;
  locate(elapsed, car);
  measure_edges(elapsed, car);
  time_laps(progress_before, elapsed);
}

void Judge::locate(double elapsed, const Sighting& car) noexcept {
  const road::Path& line = track_->centre();
  const Vec2 position{car.pose.x, car.pose.y};
  const double reachable = 2.0 * car.speed * elapsed + 0.01 * size_;
  road::Projection nearest = line.project(position, state_.s, kSearch * size_ + reachable);
  const bool is_far = nearest.distance >
                      kLost * size_ + std::max(track_->left_width(nearest.s), track_->right_width(nearest.s));
  lost_for_ = is_far ? lost_for_ + 1 : 0;
  bool has_jumped = false;
  if (lost_for_ % kLostPatience == 1) {
    const road::Projection anywhere = project_anywhere(*track_, car.pose);
    has_jumped = anywhere.distance < 0.5 * nearest.distance;
    if (has_jumped) nearest = anywhere;
  }
  const road::PathPoint foot = line.at(nearest.s);
  double advanced = line.difference(nearest.s, state_.s);
  if (!line.is_closed()) {
    // Beyond its ends an open line continues straight.
    const Vec2 tangent{cos(foot.heading), sin(foot.heading)};
    const double beyond = (position - foot.position).dot(tangent);
    const bool is_end = nearest.s <= 0.0 || nearest.s >= line.length();
    advanced = nearest.s + (is_end ? beyond : 0.0) - track_->start_s() - state_.progress;
  }
  if (!has_jumped) covered_ += std::clamp(advanced, -reachable, reachable);
  state_.progress += advanced;
  state_.s = nearest.s;
  state_.lateral_error = nearest.d;
  state_.heading_error = wrap_angle(car.pose.psi - foot.heading);
}

void Judge::measure_edges(double elapsed, const Sighting& car) noexcept {
  const model::Pose& pose = car.pose;
  const double c = cos(pose.psi);
  const double s = sin(pose.psi);
  double edge = std::numeric_limits<double>::infinity();
  for (const Vec2& patch : car.contact_points) {
    const Vec2 point{pose.x + c * patch.x() - s * patch.y(), pose.y + s * patch.x() + c * patch.y()};
    const road::Projection at = track_->centre().project(point, state_.s, kSearch * size_);
    edge = std::min(edge, track_->edge_distance(at));
  }
  state_.edge_distance = edge + track_->kerb_width();
  state_.min_edge_distance = std::min(state_.min_edge_distance, state_.edge_distance);
  back_on_track_ = state_.edge_distance >= kBackOnTrack * size_ ? back_on_track_ + elapsed : 0.0;
  if (state_.edge_distance < 0.0) {
    state_.off_track_time += elapsed;
    if (!state_.is_off_track) ++state_.off_track_events;
    state_.is_off_track = true;
  } else if (back_on_track_ >= kBackOnTrackTime) {
    state_.is_off_track = false;
  }
}

void Judge::time_laps(double progress_before, double elapsed) noexcept {
  const double moved = state_.progress - progress_before;
  const auto crossing = [&](double mark) {
    const double share = moved > 0.0 ? std::clamp((mark - progress_before) / moved, 0.0, 1.0) : 1.0;
    return state_.time - elapsed * (1.0 - share);
  };
  const double third = lap_length_ / WorldState::kSectors;
  while (!state_.is_finished) {
    const auto corner_end = [&] { return next_line_ - lap_length_ + corner_ends_[corner_]; };
    while (state_.is_timed && corner_ + 1 < corner_ends_.size() && state_.progress >= corner_end())
      end_corner(crossing(corner_end()));
    const bool is_last = !state_.is_timed || state_.sector == WorldState::kSectors - 1;
    const double mark = next_line_ - (is_last ? 0.0 : (WorldState::kSectors - 1 - state_.sector) * third);
    if (state_.progress < mark) break;
    if (is_last) {
      cross_line(crossing(mark));
    } else {
      state_.sector_times[static_cast<std::size_t>(state_.sector)] = crossing(mark) - sector_start_;
      sector_start_ = crossing(mark);
      ++state_.sector;
    }
  }
  state_.lap_time = state_.is_timed && !state_.is_finished ? state_.time - lap_start_ : 0.0;
}

void Judge::end_corner(double crossing_time) noexcept {
  corner_times_[corner_++] = crossing_time - corner_start_;
  corner_start_ = crossing_time;
}

void Judge::cross_line(double crossing_time) noexcept {
  if (state_.is_timed && covered_ < kCoveredShare * lap_length_) {
    ++state_.void_laps;
  } else if (state_.is_timed) {
    ++state_.lap;
    state_.sector_times.back() = crossing_time - sector_start_;
    state_.last_sector_times = state_.sector_times;
    if (corner_ < corner_times_.size()) end_corner(crossing_time);
    last_corner_times_ = corner_times_;
    state_.last_lap_time = crossing_time - lap_start_;
    const bool is_best = state_.lap == 1 || state_.last_lap_time < state_.best_lap_time;
    if (is_best) state_.best_lap_time = state_.last_lap_time;
    state_.last_lap_was_clean = state_.off_track_time == off_track_at_lap_start_;
  }
  state_.is_finished = !track_->centre().is_closed() && next_line_ > 0.0;
  next_line_ += lap_length_;
  start_lap(crossing_time);
}

void Judge::start_lap(double crossing_time) noexcept {
  state_.is_timed = true;
  state_.sector = 0;
  state_.sector_times = {};
  covered_ = 0.0;
  lap_start_ = sector_start_ = corner_start_ = crossing_time;
  corner_ = 0;
  off_track_at_lap_start_ = state_.off_track_time;
}

namespace {

/// Index of the waypoint nearest to the car; where the road crosses itself, nearest along the car's passage.
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
  // Time scale of a model car by its wheelbase (model::Similarity); 1 from a wheelbase of 1 m on.
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
