// SPDX-License-Identifier: MIT
#include "chicane/lap_time/limit.hpp"

#include "chicane/base/angle.hpp"

namespace chicane::lap_time {
namespace {

/// The closed line `lap`, with its first point at `start` [m] and its time counted from there.
road::RacingLine beginning_at(const road::RacingLine& lap, double start) {
  constexpr double kSamePlace = 1e-6;  // [m]
  const road::RacingLinePoint first = lap.at(start);
  road::RacingLine line = lap;
  line.points = {first};
  const auto add = [&](auto is_wanted) {
    for (std::size_t i = 0; i + 1 < lap.points.size(); ++i)
      if (is_wanted(lap.points[i].s - first.s)) line.points.push_back(lap.points[i]);
  };
  add([](double ahead) { return ahead > kSamePlace; });
  add([](double ahead) { return ahead < -kSamePlace; });
  line.points.push_back(first);
  for (road::RacingLinePoint& point : line.points) {
    point.time -= first.time;
    if (point.time < 0.0) point.time += lap.lap_time();
  }
  line.points.back().time = lap.lap_time();
  return line;
}

}  // namespace

Limit bound_from_start(const road::Track& track, const PlantLimit& limit) {
  Limit told{.times = limit.bound, .line = {}};
  if (limit.line.is_empty()) return told;
  told.line = road::line_points(track, beginning_at(limit.line, track.centre().wrap(track.start_s())));
  for (std::size_t i = 1; i < told.line.size(); ++i)  // continuous across the beginning of the centre line
    told.line[i].heading =
        told.line[i - 1].heading + angle_difference(told.line[i].heading, told.line[i - 1].heading);
  return told;
}

}  // namespace chicane::lap_time
