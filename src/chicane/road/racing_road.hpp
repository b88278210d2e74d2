// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "chicane/road/reference_line.hpp"
#include "chicane/road/road.hpp"
#include "chicane/road/road_data.hpp"
#include "chicane/road/track.hpp"

namespace chicane::road {

/// A planned lap, or the one way along an open road, to race by: a line with its speeds, and the road's edges
/// beside it. Immutable: made beside the loop that drives by it, and handed over whole. Look-ups allocate
/// nothing; several threads may read.
class RacingRoad {
 public:
  static constexpr double kSpacing = 1.0;  ///< of the samples [m] at most

  /// From a lap by rising time, whose last point repeats the first. `kerb`: drivable beyond the edges [m].
  /// Empty line for less than 8 points.
  explicit RacingRoad(std::span<const road::LinePoint> lap, double kerb = 0.0)
      : RacingRoad(lap, kerb, Basis{}) {}
  /// Slips of the axles over that of their tyres' peak.
  struct Slips {
    double front = 1.0;
    double rear = 1.0;
  };
  /// What a lap was planned from.
  struct Basis {
    bool is_learned = false;             ///< see is_learned()
    double grip = 1.0;                   ///< see grip()
    bool slides = false;                 ///< see slides()
    bool is_closed = true;               ///< the road; else the car is planned to stop at its end ...
    double braking = 0.0;                ///< ... with this deceleration [m/s²]
    double room_behind = 0.0;            ///< the finish, to the end [m]
    Slips slips{};                       ///< see slips()
    std::vector<double> corner_times{};  ///< see corner_times()
  };
  RacingRoad(std::span<const road::LinePoint> lap, double kerb, const Basis& basis);
  /// On `track`, which tells the room beside the line. Where a road bends tightly, that across the line is
  /// another one than across the road, and changes between the points of the lap.
  RacingRoad(std::span<const road::LinePoint> lap, const Track& track, const Basis& basis)
      : RacingRoad(lap, track.kerb_width(), basis) {
    look_at(track, lap);
  }

  /// In W, closed as the road is. The offset of its samples is that from the road's centre line [m].
  [[nodiscard]] const ReferenceLine& line() const noexcept { return line_; }
  /// From the line to the edges, kerbs included, at arc length s on it, across the line [m].
  [[nodiscard]] Road::Room room(double s) const noexcept;
  /// From the body's heading to the line's where the car is planned to slide [rad], left positive.
  [[nodiscard]] double sideslip(double s) const noexcept;
  /// Planned for the road that the controller has learned from waypoints, with an assumed width: of no use
  /// when the waypoints are forgotten.
  [[nodiscard]] bool is_learned() const noexcept { return basis_.is_learned; }
  /// The grip that it was planned with, over the one that the vehicle's parameters tell.
  [[nodiscard]] double grip() const noexcept { return basis_.grip; }
  /// Whether it was asked to slide beyond the peak of the tyres.
  [[nodiscard]] bool slides() const noexcept { return basis_.slides; }
  /// Slip beyond which the controller's cost has a weight.
  [[nodiscard]] const Slips& slips() const noexcept { return basis_.slips; }

  /// Planned times of the corners of its track [s], as lap_time::corner_times(); empty on an open
  /// road and on one that was learned.
  [[nodiscard]] const std::vector<double>& corner_times() const noexcept { return basis_.corner_times; }

 private:
  /// Between two samples: the first, and the share of the second.
  struct Place {
    std::size_t sample;
    double share;
  };
  [[nodiscard]] Place place(double s) const noexcept;
  void stop_at_end() noexcept;
  void look_at(const Track& track, std::span<const road::LinePoint> lap) noexcept;

  ReferenceLine line_;
  std::vector<Road::Room> rooms_;  ///< at the line's samples
  std::vector<double> sideslips_;
  Basis basis_;
};

}  // namespace chicane::road
