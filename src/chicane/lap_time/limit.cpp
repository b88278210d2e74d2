// SPDX-License-Identifier: MIT
#include "chicane/lap_time/limit.hpp"

#include <algorithm>

#include "chicane/base/angle.hpp"
#include "chicane/road/corners.hpp"

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

std::vector<double> corner_times(const road::Track& track, const road::RacingLine& line) {
  if (line.is_empty()) return {};
  const road::RacingLine lap = beginning_at(line, track.centre().wrap(track.start_s()));
  const auto distance = [&](std::size_t i) {
    return i + 1 < lap.points.size() ? track.centre().wrap(lap.points[i].s - lap.points.front().s)
                                     : track.length();
  };
  std::vector<double> times = road::corner_sectors(track, road::corners_of(track));
  double begin = 0.0;
  std::size_t i = 1;
  for (double& time : times) {
    while (i + 1 < lap.points.size() && distance(i) < time) ++i;
    const double share = (time - distance(i - 1)) / (distance(i) - distance(i - 1));
    const double end =
        lap.points[i - 1].time + std::min(share, 1.0) * (lap.points[i].time - lap.points[i - 1].time);
    time = end - begin;
    begin = end;
  }
  return times;
}

Limit bound_from_start(const road::Track& track, const PlantLimit& limit) {
  Limit from_start{.times = limit.bound, .line = {}};
  if (limit.line.is_empty()) return from_start;
  from_start.line = road::line_points(track, beginning_at(limit.line, track.centre().wrap(track.start_s())));
  for (std::size_t i = 1; i < from_start.line.size();
       ++i)  // continuous across the beginning of the centre line
    from_start.line[i].heading = from_start.line[i - 1].heading +
                                 angle_difference(from_start.line[i].heading, from_start.line[i - 1].heading);
  from_start.times.corners = corner_times(track, limit.line);
  return from_start;
}

}  // namespace chicane::lap_time
