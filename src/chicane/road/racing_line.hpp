// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace chicane::road {

/// A car at one place of a lap that is planned with its whole motion: where it is across the road, how it
/// moves, and what is asked of it there.
struct RacingLinePoint {
  double s = 0.0;             ///< along the road's centre line [m]
  double time = 0.0;          ///< since s = 0 of the lap [s]
  double offset = 0.0;        ///< of the centre of mass from the centre line, left positive [m]
  double heading = 0.0;       ///< of the body against the centre line's tangent, left positive [rad]
  double vx = 0.0;            ///< velocity of the centre of mass along the body [m/s]
  double vy = 0.0;            ///< and to its left [m/s]
  double yaw_rate = 0.0;      ///< [rad/s]
  double steer = 0.0;         ///< road-wheel angle that the car has here [rad], left positive
  double steer_asked = 0.0;   ///< that is asked of the steering here: ahead of `steer` by its lag [rad]
  double acceleration = 0.0;  ///< change of vx, drag and cornering resistance included [m/s²]
  double throttle = 0.0;      ///< the pedal asked for here, [-1, 1]
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

}  // namespace chicane::road
