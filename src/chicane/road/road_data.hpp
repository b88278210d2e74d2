// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "chicane/road/track.hpp"

namespace chicane::road {

/// A car at one place of a lap that is planned with its whole motion: where it is across the road, how it
/// moves, and what is asked of it there.
struct RacingLinePoint {
  double s = 0.0;              ///< along the road's centre line [m]
  double time = 0.0;           ///< since s = 0 of the lap [s]
  double offset = 0.0;         ///< of the centre of mass from the centre line, left positive [m]
  double heading = 0.0;        ///< of the body against the centre line's tangent, left positive [rad]
  double vx = 0.0;             ///< velocity of the centre of mass along the body [m/s]
  double vy = 0.0;             ///< and to its left [m/s]
  double yaw_rate = 0.0;       ///< [rad/s]
  double steer = 0.0;          ///< road-wheel angle that the car has here [rad], left positive
  double steer_command = 0.0;  ///< that is asked of the steering here: ahead of `steer` by its lag [rad]
  double acceleration = 0.0;   ///< change of vx, drag and cornering resistance included [m/s²]
  double throttle = 0.0;       ///< the pedal asked for here, [-1, 1]
};

/// A lap planned for one car on one closed road, as plain data: what a limit hands to controllers, files and
/// views that do not know how it was found (docs/limit.md).
struct RacingLine {
  std::string car{};                      ///< for which it was made: name of a plant
  std::string track{};                    ///< and of the road
  double length = 0.0;                    ///< of the road's centre line [m]
  double margin = 0.0;                    ///< that each contact patch keeps from edge and kerb [m]
  bool is_best_so_far = false;            ///< the search ended by its budget, before the optimum
  std::vector<RacingLinePoint> points{};  ///< by rising s from 0 to length; the last repeats the first

  [[nodiscard]] double lap_time() const noexcept { return points.empty() ? 0.0 : points.back().time; }
  [[nodiscard]] bool is_empty() const noexcept { return points.size() < 2; }

  /// Any s, wrapped into [0, length); all values interpolated between the neighbouring points, `time` within
  /// the lap. Zeros for an empty line. O(log n), allocates nothing.
  [[nodiscard]] RacingLinePoint at(double s) const noexcept;
};

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
/// (docs/decisions/0014-modules-of-a-run.md).
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
