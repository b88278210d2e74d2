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
constexpr double kSearch = 6.0;             // reach of a local projection [m]
constexpr double kLost = 8.0;             // farther off the road than this: look for the line everywhere [m]
constexpr int kLostPatience = 10;         // judgements between such looks
constexpr double kCoveredShare = 0.95;    // of the line that a lap has to cover
constexpr double kBackOnTrack = 0.05;     // distance that ends an off-track event [m] ...
constexpr double kBackOnTrackTime = 0.2;  // ... once held so long [s]

}  // namespace

World::World(Plant& plant, const path::Track& track) noexcept : plant_{plant}, track_{track} {
  steps_per_judgement_ = std::max(1, static_cast<int>(std::lround(kJudgementPeriod / plant.step_length())));
  lap_length_ = track.length() - (track.centre().is_closed() ? 0.0 : track.start_s());
  place(track.start_s(), track.start_d());
}

void World::place(double s, double offset, double speed) noexcept {
  const path::PathPoint point = track_.centre().at(s);
  reset({.x = point.position.x() - offset * sin(point.heading),
         .y = point.position.y() + offset * cos(point.heading),
         .psi = point.heading},
        speed);
}

void World::reset(const model::Pose& pose, double speed) noexcept {
  plant_.reset(pose, speed);
  step_count_ = 0;
  covered_ = lap_start_ = sector_start_ = off_track_at_lap_start_ = back_on_track_ = 0.0;
  lost_for_ = 0;
  state_ = {};
  // A start on the line is timed from standstill; any other first drives to the line.
  constexpr double kOnTheLine = 1.0;  // [m]
  const path::Path& line = track_.centre();
  state_.s = line.project({pose.x, pose.y}).s;
  state_.progress = line.difference(state_.s, track_.start_s());
  state_.is_timed = std::fabs(state_.progress) <= kOnTheLine;
  if (line.is_closed() && state_.progress > kOnTheLine) state_.progress -= lap_length_;
  next_line_ = state_.is_timed || !line.is_closed() ? lap_length_ : 0.0;
  locate(0.0);
  state_.min_edge_distance = std::numeric_limits<double>::infinity();
  measure_edges(0.0);
}

void World::advance(const model::Command& command) noexcept {
  plant_.advance(command);
  ++step_count_;
  if (step_count_ % steps_per_judgement_ == 0) judge();
}

void World::judge() noexcept {
  const double elapsed = time() - state_.time;
  const double progress_before = state_.progress;
  state_.time = time();
  locate(elapsed);
  measure_edges(elapsed);
  time_laps(progress_before, elapsed);
}

void World::locate(double elapsed) noexcept {
  const path::Path& line = track_.centre();
  const model::State& car = plant_.state();
  const Vec2 position{car.x, car.y};
  const double reachable = 2.0 * plant_.output().speed * elapsed + 0.01;
  path::Projection nearest = line.project(position, state_.s, kSearch + reachable);
  const bool is_far =
      nearest.distance > kLost + std::max(track_.left_width(nearest.s), track_.right_width(nearest.s));
  lost_for_ = is_far ? lost_for_ + 1 : 0;
  bool has_jumped = false;
  if (lost_for_ % kLostPatience == 1) {
    const path::Projection anywhere = line.project(position);
    has_jumped = anywhere.distance < 0.5 * nearest.distance;
    if (has_jumped) nearest = anywhere;
  }
  const path::PathPoint foot = line.at(nearest.s);
  double advanced = line.difference(nearest.s, state_.s);
  if (!line.is_closed()) {
    // Beyond its ends an open line goes on straight.
    const Vec2 tangent{cos(foot.heading), sin(foot.heading)};
    const double beyond = (position - foot.position).dot(tangent);
    const bool is_end = nearest.s <= 0.0 || nearest.s >= line.length();
    advanced = nearest.s + (is_end ? beyond : 0.0) - track_.start_s() - state_.progress;
  }
  if (!has_jumped) covered_ += std::clamp(advanced, -reachable, reachable);
  state_.progress += advanced;
  state_.s = nearest.s;
  state_.lateral_error = nearest.d;
  state_.heading_error = wrap_angle(car.psi - foot.heading);
}

void World::measure_edges(double elapsed) noexcept {
  const model::State& car = plant_.state();
  const double c = cos(car.psi);
  const double s = sin(car.psi);
  double edge = std::numeric_limits<double>::infinity();
  for (const Vec2& patch : plant_.contact_points()) {
    const Vec2 point{car.x + c * patch.x() - s * patch.y(), car.y + s * patch.x() + c * patch.y()};
    const path::Projection at = track_.centre().project(point, state_.s, kSearch);
    edge = std::min(edge, track_.edge_distance(at));
  }
  state_.edge_distance = edge + track_.kerb_width();
  state_.min_edge_distance = std::min(state_.min_edge_distance, state_.edge_distance);
  back_on_track_ = state_.edge_distance >= kBackOnTrack ? back_on_track_ + elapsed : 0.0;
  if (state_.edge_distance < 0.0) {
    state_.off_track_time += elapsed;
    if (!state_.is_off_track) ++state_.off_track_events;
    state_.is_off_track = true;
  } else if (back_on_track_ >= kBackOnTrackTime) {
    state_.is_off_track = false;
  }
}

void World::time_laps(double progress_before, double elapsed) noexcept {
  const double moved = state_.progress - progress_before;
  const auto crossing = [&](double mark) {
    const double share = moved > 0.0 ? std::clamp((mark - progress_before) / moved, 0.0, 1.0) : 1.0;
    return state_.time - elapsed * (1.0 - share);
  };
  const double third = lap_length_ / WorldState::kSectors;
  while (!state_.is_finished) {
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

void World::cross_line(double crossing_time) noexcept {
  if (state_.is_timed && covered_ < kCoveredShare * lap_length_) {
    ++state_.void_laps;
  } else if (state_.is_timed) {
    ++state_.lap;
    state_.sector_times.back() = crossing_time - sector_start_;
    state_.last_sector_times = state_.sector_times;
    state_.last_lap_time = crossing_time - lap_start_;
    const bool is_best = state_.lap == 1 || state_.last_lap_time < state_.best_lap_time;
    if (is_best) state_.best_lap_time = state_.last_lap_time;
    state_.last_lap_was_clean = state_.off_track_time == off_track_at_lap_start_;
  }
  state_.is_finished = !track_.centre().is_closed();
  next_line_ += lap_length_;
  start_lap(crossing_time);
}

void World::start_lap(double crossing_time) noexcept {
  state_.is_timed = true;
  state_.sector = 0;
  state_.sector_times = {};
  covered_ = 0.0;
  lap_start_ = sector_start_ = crossing_time;
  off_track_at_lap_start_ = state_.off_track_time;
}

int select_waypoints(const path::Track& track, const model::Pose& pose, int count,
                     model::Measurement& measurement) noexcept {
  const auto& points = track.raw_points();
  const int size = static_cast<int>(points.size());
  const bool is_closed = track.centre().is_closed();
  const Vec2 position{pose.x, pose.y};
  int next = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < size; ++i) {
    const double squared = (points[static_cast<std::size_t>(i)].position - position).squaredNorm();
    if (squared < nearest) {
      nearest = squared;
      next = i;
    }
  }
  measurement.waypoint_count = 0;
  if (size == 0) return 0;
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
