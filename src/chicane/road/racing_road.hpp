// SPDX-License-Identifier: MIT
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

/// State of a car at one place of a lap that is planned with its whole motion: offset from the road's line,
/// motion, and inputs.
struct RacingLinePoint {
  double s = 0.0;              ///< along the road's centre line [m]
  double time = 0.0;           ///< time since s = 0 of the lap [s]
  double offset = 0.0;         ///< offset of the centre of mass from the centre line, left positive [m]
  double heading = 0.0;        ///< heading of the body against the centre line's tangent, left positive [rad]
  double vx = 0.0;             ///< velocity of the centre of mass along the body [m/s]
  double vy = 0.0;             ///< speed to the body's left [m/s]
  double yaw_rate = 0.0;       ///< [rad/s]
  double steer = 0.0;          ///< road-wheel angle that the car has here [rad], left positive
  double steer_command = 0.0;  ///< demand to the steering, ahead of `steer` by its lag [rad]
  double acceleration = 0.0;   ///< change of vx, drag and cornering resistance included [m/s²]
  double throttle = 0.0;       ///< the pedal asked for here, [-1, 1]
};

/// A lap planned for one car on one closed road, as plain data for controllers, files and views, which do not
/// depend on the method (docs/limit.md).
struct RacingLine {
  std::string car{};                      ///< name of the plant that it was planned for
  std::string track{};                    ///< name of the road
  double length = 0.0;                    ///< length of the road's centre line [m]
  double margin = 0.0;                    ///< gap of each contact patch to edge and kerb [m]
  bool is_best_so_far = false;            ///< the search ended before the optimum
  std::vector<RacingLinePoint> points{};  ///< points by rising s from 0 to length; the last repeats the first

  [[nodiscard]] double lap_time() const noexcept { return points.empty() ? 0.0 : points.back().time; }
  [[nodiscard]] bool is_empty() const noexcept { return points.size() < 2; }

  /// Any s, wrapped into [0, length); all values interpolated between the neighbouring points, `time` within
  /// the lap. Zeros for an empty line. O(log n), allocates nothing.
  [[nodiscard]] RacingLinePoint at(double s) const noexcept;
};

/// One cross-section of a road, on its centre line.
struct RoadPoint {
  double s = 0.0;          ///< along the centre line, from its beginning [m]
  Vec2 position = Vec2{};  ///< position of the centre line in W [m]
  double heading = 0.0;    ///< heading of its tangent [rad], continuous along the road (not wrapped)
  double curvature = 0.0;  ///< [1/m], left positive
  double left = 0.0;       ///< distance from the centre line to the left edge [m]
  double right = 0.0;      ///< distance from the centre line to the right edge [m]
};

/// A car at one place of a line that it drives: where, how fast, and with which accelerations.
struct LinePoint {
  double s = 0.0;                          ///< along the road's centre line, from its beginning [m]
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

/// A road, and how it may be driven, as plain data: what modules that do not know each other hand over
/// (docs/decisions/0014-modules-of-a-run.md).
struct RoadData {
  bool is_closed = false;
  double length = 0.0;            ///< length of the centre line [m]
  std::vector<RoadPoint> points;  ///< by rising s from 0 to length; a closed road's last repeats its first
  std::vector<LinePoint> racing_line;  ///< by rising time; a lap's last repeats its first; empty: none known
};

/// The road of a track, at points spaced evenly by at most `spacing` [m]; no racing line. On a closed road
/// the last point has s = length and the first one's heading plus a lap's turning. Pre: spacing > 0.
[[nodiscard]] RoadData road_data(const Track& track, double spacing);

/// The line that the centre of mass follows on a planned lap of `track`, by rising time; the last point
/// repeats the first. Empty for an empty line.
[[nodiscard]] std::vector<LinePoint> line_points(const Track& track, const RacingLine& line);

/// Planned lap, or passage of an open road, to race by: a line with its speeds, and the distances to the
/// road's edges. Immutable: made outside the control loop, and handed over whole. Look-ups allocate nothing;
/// several threads may read.
class RacingRoad {
 public:
  static constexpr double kSpacing = 1.0;  ///< largest spacing of the samples [m]

  /// Road from a lap by rising time, whose last point repeats the first. `kerb`: drivable beyond the edges
  /// [m]. Empty line for less than 8 points.
  explicit RacingRoad(std::span<const road::LinePoint> lap, double kerb = 0.0)
      : RacingRoad(lap, kerb, Basis{}) {}
  /// Slips of the axles over the slip at their tyres' peak.
  struct Slips {
    double front = 1.0;
    double rear = 1.0;
  };
  /// Terms that a lap was planned with.
  struct Basis {
    bool is_learned = false;             ///< see is_learned()
    LapTerms terms{};                    ///< see terms()
    bool is_closed = true;               ///< the road; else the car is planned to stop at its end ...
    double braking = 0.0;                ///< ... with this deceleration [m/s²]
    double room_behind = 0.0;            ///< the finish, to the end [m]
    Slips slips{};                       ///< see slips()
    std::vector<double> corner_times{};  ///< see corner_times()
  };
  RacingRoad(std::span<const road::LinePoint> lap, double kerb, const Basis& basis);
  /// Road on `track`, which gives the room on both sides. In tight bends the room across the line differs
  /// from the room across the road, and changes between the points of the lap.
  RacingRoad(std::span<const road::LinePoint> lap, const Track& track, const Basis& basis)
      : RacingRoad(lap, track.kerb_width(), basis) {
    look_at(track, lap);
  }

  /// Line in W, closed if the road is. The offset of its samples is from the road's centre line [m].
  [[nodiscard]] const ReferenceLine& line() const noexcept { return line_; }
  /// Distances from the line to the edges, kerbs included, at arc length s on it, across the line [m].
  [[nodiscard]] Road::Room room(double s) const noexcept;
  /// Angle from the body's heading to the line's, where the car is planned to slide [rad], left positive.
  [[nodiscard]] double sideslip(double s) const noexcept;
  /// Whether it was planned for a road learned from waypoints, with an assumed width: void when the waypoints
  /// are dropped.
  [[nodiscard]] bool is_learned() const noexcept { return basis_.is_learned; }
  /// Grip, slides and slip that it was planned for.
  [[nodiscard]] const LapTerms& terms() const noexcept { return basis_.terms; }
  /// Slip beyond which the controller's cost has a weight.
  [[nodiscard]] const Slips& slips() const noexcept { return basis_.slips; }

  /// Planned times of the corners of its track [s], as lap_time::corner_times(); empty on an open
  /// road and on one that was learned.
  [[nodiscard]] const std::vector<double>& corner_times() const noexcept { return basis_.corner_times; }

 private:
  /// Place between two samples: index of the first, weight of the second.
  struct Place {
    std::size_t sample;
    double share;
  };
  [[nodiscard]] Place place(double s) const noexcept;
  void stop_at_end() noexcept;
  void look_at(const Track& track, std::span<const road::LinePoint> lap) noexcept;

  ReferenceLine line_;
  std::vector<Road::Room> rooms_;  ///< room at the line's samples
  std::vector<double> sideslips_;
  Basis basis_;
};

/// The road that a controller drives on: what waypoints show of it, or a planned lap to race by. A lap that
/// was planned for the road as learned from waypoints is given up where those are of another road. Allocates
/// at construction only; one thread.
class DrivenRoad {
 public:
  DrivenRoad(const RoadOptions& options, const model::VehicleParams& vehicle) : seen_{options, vehicle} {}
  void configure(const RoadOptions& options, const model::VehicleParams& vehicle) noexcept {
    seen_.configure(options, vehicle);
  }

  /// A lap to race by from now on; null: the waypoints.
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

  /// Line in W; empty if nothing is known.
  [[nodiscard]] const ReferenceLine& line() const noexcept { return lap_ ? lap_->line() : seen_.line(); }
  /// Number of the line: positions along an older one are void.
  [[nodiscard]] unsigned revision() const noexcept { return seen_.revision() + laps_; }
  /// The planned lap; null: none.
  [[nodiscard]] const RacingRoad* lap() const noexcept { return lap_.get(); }
  /// Road::room() and Road::closed_waypoints() of the road as seen.
  [[nodiscard]] const Road& seen() const noexcept { return seen_; }

 private:
  [[nodiscard]] bool is_learned() const noexcept { return lap_ && lap_->is_learned(); }

  Road seen_;
  std::shared_ptr<const RacingRoad> lap_;
  unsigned laps_ = 0;
};

}  // namespace chicane::road
