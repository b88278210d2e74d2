// SPDX-License-Identifier: MIT
// Planned laps as plain data, RacingRoad, which is such a lap to drive by, and the road of a controller.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/reference_line.hpp"
#include "chicane/road/road.hpp"
#include "chicane/road/track.hpp"

namespace chicane::road {

/// State and inputs of a car at one point of a planned lap.
struct RacingLinePoint {
  double s = 0.0;              ///< arc length along the road's centre line [m]
  double time = 0.0;           ///< time since s = 0 of the lap [s]
  double offset = 0.0;         ///< offset of the centre of mass from the centre line, left positive [m]
  double heading = 0.0;        ///< heading of the body against the centre line's tangent, left positive [rad]
  double vx = 0.0;             ///< velocity of the centre of mass along the body [m/s]
  double vy = 0.0;             ///< velocity to the body's left [m/s]
  double yaw_rate = 0.0;       ///< [rad/s]
  double steer = 0.0;          ///< road-wheel angle [rad], left positive
  double steer_command = 0.0;  ///< command to the steering, ahead of `steer` by its lag [rad]
  double acceleration = 0.0;   ///< rate of vx, drag and cornering resistance included [m/s²]
  double throttle = 0.0;       ///< command to the pedal, [-1, 1]
};

/// Lap planned for one car on one closed road, as plain data for controllers, files and views, which do not
/// depend on the method of planning (docs/limit.md).
struct RacingLine {
  std::string car{};                      ///< name of the plant that it was planned for
  std::string track{};                    ///< name of the road
  double length = 0.0;                    ///< length of the road's centre line [m]
  double margin = 0.0;                    ///< gap of each contact patch to edge and kerb [m]
  bool is_best_so_far = false;            ///< the search ended before the optimum
  std::vector<RacingLinePoint> points{};  ///< points by rising s from 0 to length; the last repeats the first

  [[nodiscard]] double lap_time() const noexcept { return points.empty() ? 0.0 : points.back().time; }
  [[nodiscard]] bool is_empty() const noexcept { return points.size() < 2; }

  /// Point at any s, which is wrapped into [0, length): all values interpolated between the neighbouring
  /// points. Zeros for an empty line. O(log n), allocates nothing.
  [[nodiscard]] RacingLinePoint at(double s) const noexcept;
};

/// Cross-section of a road, by its point on the centre line.
struct RoadPoint {
  double s = 0.0;          ///< arc length along the centre line [m]
  Vec2 position = Vec2{};  ///< position of the centre line in W [m]
  double heading = 0.0;    ///< heading of its tangent [rad], continuous along the road (not wrapped)
  double curvature = 0.0;  ///< [1/m], left positive
  double left = 0.0;       ///< distance from the centre line to the left edge [m]
  double right = 0.0;      ///< distance from the centre line to the right edge [m]
};

/// Car at one point of a driven line: position, speed, accelerations, and distances to the edges.
struct LinePoint {
  double s = 0.0;                          ///< arc length along the road's centre line [m]
  double time = 0.0;                       ///< time since the line's first point [s]
  double d = 0.0;                          ///< offset of centre of mass from centre line, left positive [m]
  Vec2 position = Vec2{};                  ///< position of the centre of mass in W [m]
  double heading = 0.0;                    ///< heading of the line [rad], continuous along it (not wrapped)
  double curvature = 0.0;                  ///< curvature of the line, left positive [1/m]
  double speed = 0.0;                      ///< [m/s]
  double longitudinal_acceleration = 0.0;  ///< along the line, drag included [m/s²]
  double lateral_acceleration = 0.0;       ///< centripetal, left positive [m/s²]
  double left = 0.0;                       ///< distance from the centre of mass to the left edge [m]
  double right = 0.0;                      ///< distance from the centre of mass to the right edge [m]
  double sideslip = 0.0;                   ///< angle from body to line, left positive [rad]
};

/// Road with a racing line as plain data, which modules that do not know each other exchange
/// (docs/decisions/0014-modules-of-a-run.md).
struct RoadData {
  bool is_closed = false;
  double length = 0.0;            ///< length of the centre line [m]
  std::vector<RoadPoint> points;  ///< by rising s from 0 to length; a closed road's last repeats its first
  std::vector<LinePoint> racing_line;  ///< points by rising time; a lap's last repeats its first; empty: none
};

/// Road of a track, at points spaced evenly by at most `spacing` [m], without a racing line. On a closed road
/// the last point has s = length, and the first point's heading plus the turning of a lap. Pre: spacing > 0.
[[nodiscard]] RoadData road_data(const Track& track, double spacing);

/// Line of the centre of mass on a planned lap of `track`, by rising time; the last point repeats the first.
/// Empty for an empty line.
[[nodiscard]] std::vector<LinePoint> line_points(const Track& track, const RacingLine& line);

/// Planned lap, or passage of an open road, to race by: a line with its speeds, and the distances to the
/// road's edges. Immutable: made outside the control loop, which receives it as a whole. Look-ups allocate
/// nothing; several threads may read.
class RacingRoad {
 public:
  static constexpr double kSpacing = 1.0;  ///< largest spacing of the samples [m]

  /// Road from a lap by rising time, whose last point repeats the first. `kerb`: drivable width beyond each
  /// edge [m]. The line is empty for less than 8 points.
  explicit RacingRoad(std::span<const LinePoint> lap, double kerb = 0.0) : RacingRoad(lap, kerb, Basis{}) {}
  /// Slips of the axles, as multiples of the slip at their tyres' peak.
  struct Slips {
    double front = 1.0;
    double rear = 1.0;
  };
  /// Terms that a lap was planned with.
  struct Basis {
    bool is_learned = false;   ///< see is_learned()
    LapTerms terms{};          ///< see terms()
    bool is_closed = true;     ///< whether the road is closed; a car stops at the end of an open one
    double braking = 0.0;      ///< deceleration of that stop [m/s²]
    double room_behind = 0.0;  ///< distance from the finish of an open road to its end [m]
    Slips slips{};             ///< see slips()
    std::vector<double> corner_times{};  ///< see corner_times()
  };
  RacingRoad(std::span<const LinePoint> lap, double kerb, const Basis& basis);
  /// Road on `track`. For a lap that slides the room is measured from the line to the track's edges: in tight
  /// bends it differs from the room across the road, and changes between the points of the lap.
  RacingRoad(std::span<const LinePoint> lap, const Track& track, const Basis& basis)
      : RacingRoad(lap, track.kerb_width(), basis) {
    measure_rooms(track, lap);
  }

  /// Line in W, closed if the road is. Its samples have their offset from the road's centre line.
  [[nodiscard]] const ReferenceLine& line() const noexcept { return line_; }
  /// Distances across the line to the edges, kerbs included [m], at its arc length s [m].
  [[nodiscard]] Road::Room room(double s) const noexcept;
  /// Planned angle from the body's heading to the line's [rad], left positive.
  [[nodiscard]] double sideslip(double s) const noexcept;
  /// Whether the road was learned from waypoints, with an assumed width. The lap is void when the waypoints
  /// are dropped.
  [[nodiscard]] bool is_learned() const noexcept { return basis_.is_learned; }
  /// Grip, slides and slip of the plan.
  [[nodiscard]] const LapTerms& terms() const noexcept { return basis_.terms; }
  /// Slip of each axle beyond which the controller's cost has a weight.
  [[nodiscard]] const Slips& slips() const noexcept { return basis_.slips; }

  /// Planned times of the track's corners [s], as lap_time::corner_times() has them; empty on an open or
  /// learned road.
  [[nodiscard]] const std::vector<double>& corner_times() const noexcept { return basis_.corner_times; }

 private:
  /// Position between two samples of the line.
  struct Place {
    std::size_t sample;  ///< index of the first sample
    double share;        ///< weight of the second one
  };
  [[nodiscard]] Place place(double s) const noexcept;
  /// Lowers the speeds so that the car stops before the end of an open road.
  void stop_at_end() noexcept;
  /// Lowers the rooms of a lap that slides to the distances from the line to the track's edges.
  void measure_rooms(const Track& track, std::span<const LinePoint> lap) noexcept;

  ReferenceLine line_;
  std::vector<Road::Room> rooms_;  ///< rooms at the line's samples
  std::vector<double> sideslips_;  ///< sideslips at the line's samples [rad]
  Basis basis_;
};

/// Road that a controller drives on: the one learned from waypoints, or a planned lap to race by. A lap
/// planned for the learned road is dropped when the waypoints turn out to be of another road. Allocates at
/// construction only; one thread.
class DrivenRoad {
 public:
  DrivenRoad(const RoadOptions& options, const model::VehicleParams& vehicle) : seen_{options, vehicle} {}
  /// Applies other settings to the road learned from waypoints.
  void configure(const RoadOptions& options, const model::VehicleParams& vehicle) noexcept {
    seen_.configure(options, vehicle);
  }

  /// Sets a lap to race by from now on; null: the road learned from waypoints.
  void race_by(std::shared_ptr<const RacingRoad> lap) noexcept {
    lap_ = std::move(lap);
    ++laps_;
  }
  [[nodiscard]] bool is_raced() const noexcept { return lap_ != nullptr; }

  /// Adds the waypoints of a measurement, if they are new. False if a learned lap had to be dropped.
  [[nodiscard]] bool add(const model::Measurement& now) noexcept {
    if (!is_raced() || is_learned()) seen_.add(now);
    if (!is_learned() || !seen_.closed_waypoints().empty()) return true;
    race_by(nullptr);
    return false;
  }
  /// Forgets the waypoints, and a lap that was planned from them.
  void reset() noexcept {
    if (is_learned()) race_by(nullptr);
    seen_.reset();
  }

  /// Line in W; empty while no road is known.
  [[nodiscard]] const ReferenceLine& line() const noexcept { return lap_ ? lap_->line() : seen_.line(); }
  /// Number that changes with the line. Positions along an older line are invalid.
  [[nodiscard]] unsigned revision() const noexcept { return seen_.revision() + laps_; }
  /// Planned lap; null: none.
  [[nodiscard]] const RacingRoad* lap() const noexcept { return lap_.get(); }
  /// Road learned from waypoints.
  [[nodiscard]] const Road& seen() const noexcept { return seen_; }

 private:
  [[nodiscard]] bool is_learned() const noexcept { return lap_ && lap_->is_learned(); }

  Road seen_;                              ///< road learned from waypoints
  std::shared_ptr<const RacingRoad> lap_;  ///< planned lap; null: none
  unsigned laps_ = 0;                      ///< number of changes of lap_
};

}  // namespace chicane::road
