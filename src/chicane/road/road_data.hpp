// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "chicane/road/racing_line.hpp"
#include "chicane/road/track.hpp"

namespace chicane::road {

/// One cross-section of a road, on its centre line.
struct RoadPoint {
  double s = 0.0;          ///< along the centre line, from its beginning [m]
  Vec2 position = Vec2{};  ///< of the centre line in W [m]
  double heading = 0.0;    ///< of its tangent [rad], continuous along the road (not wrapped)
  double curvature = 0.0;  ///< [1/m], left positive
  double left = 0.0;       ///< from the centre line to the edge on the left [m]
  double right = 0.0;      ///< and on the right [m]
};

/// A car at one place of a line that it drives: where, how fast, and with which accelerations.
struct LinePoint {
  double s = 0.0;                          ///< along the road's centre line, from its beginning [m]
  double time = 0.0;                       ///< since the line's first point [s]
  double d = 0.0;                          ///< of the centre of mass from the centre line, left positive [m]
  Vec2 position = Vec2{};                  ///< of the centre of mass in W [m]
  double heading = 0.0;                    ///< of the line [rad], continuous along it (not wrapped)
  double curvature = 0.0;                  ///< of the line, left positive [1/m]
  double speed = 0.0;                      ///< [m/s]
  double longitudinal_acceleration = 0.0;  ///< along the line, drag included [m/s²]
  double lateral_acceleration = 0.0;       ///< centripetal, left positive [m/s²]
  double left = 0.0;                       ///< from the centre of mass to the edge on the left [m]
  double right = 0.0;                      ///< and on the right [m]
  double sideslip = 0.0;                   ///< from the body's heading to the line's, left positive [rad]
};

/// A road, and how it may be driven, as plain data: what modules that do not know each other hand over
/// (docs/decisions/0013-road-data-lives-in-path.md).
struct RoadData {
  bool is_closed = false;
  double length = 0.0;            ///< of the centre line [m]
  std::vector<RoadPoint> points;  ///< by rising s from 0 to length; a closed road's last repeats its first
  std::vector<LinePoint> racing_line;  ///< by rising time; a lap's last repeats its first; empty: none known
};

/// The road of a track, at points spaced evenly by at most `spacing` [m]; no racing line. On a closed road
/// the last point has s = length and the first one's heading plus a lap's turning. Pre: spacing > 0.
[[nodiscard]] RoadData road_data(const Track& track, double spacing);

/// The line that the centre of mass follows on a planned lap of `track`, by rising time; the last point
/// repeats the first. Empty for an empty line.
[[nodiscard]] std::vector<LinePoint> line_points(const Track& track, const RacingLine& line);

}  // namespace chicane::road
