// SPDX-License-Identifier: MIT
// KnownRoad: the line and the edges by which the guard plans stops.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/road/reference_line.hpp"
#include "chicane/road/road.hpp"
#include "chicane/road/track.hpp"

namespace chicane::road {

/// Road as the guard knows it: a line with the distances to both edges. It is a track's, complete from the
/// beginning, or learned from the waypoints of measurements, with an assumed width. A planned racing line can
/// take the place of the middle of either. All memory is reserved at construction; one thread.
class KnownRoad {
 public:
  /// Empty road that learns nothing: for a guard that is off.
  KnownRoad() : line_{2} {}
  /// Road of a track. A closed one has the line that a controller would plan from the track's waypoints, so
  /// that its bends are as wide as driven ones. Pre: `data` has at least two points.
  KnownRoad(const RoadData& data, const model::VehicleParams& vehicle);
  /// Road learned from waypoints; `half_width`: assumed distance from their line to each edge [m].
  KnownRoad(double half_width, const model::VehicleParams& vehicle);

  /// Replaces the line by that of a planned lap; edges() and target() are relative to it from then on. On a
  /// road from waypoints the edges stay `half_width` from the waypoints' line, and reset() restores that
  /// line. Allocates; null changes nothing.
  void use_line(const RacingRoad* lap);

  /// Forgets the waypoints, and a racing line planned from them; does nothing on a track.
  void reset() noexcept;
  /// Learns the waypoints of a measurement; does nothing on a track.
  void add(const model::Measurement& now) noexcept;

  /// Line in W; empty while no road is known.
  [[nodiscard]] const ReferenceLine& line() const noexcept { return is_learning() ? seen_->line() : line_; }
  /// Distances from the line to the edges, both positive on the road [m].
  using Edges = Road::Room;
  /// Edges at arc length s [m] of the line. Pre: the line is not empty.
  [[nodiscard]] Edges edges(double s) const noexcept;
  /// Values that each step of a simulated stop needs at its place, in one look-up.
  struct Here {
    double curvature = 0.0;  ///< curvature of the line [1/m]
    Edges narrowest{};       ///< lower bounds of edges() within kReach; minus infinity with waypoints [m]
  };
  [[nodiscard]] Here here(double s) const noexcept;
  static constexpr double kReach =
      6.0;  ///< [m] derived: twice the longest way from a car's middle to an axle
  /// End of an open road [m]. A road from waypoints is assumed to continue straight to the next waypoint (as
  /// far as the last two are apart, at most 25 m), and beyond it by half its width.
  [[nodiscard]] double end() const noexcept {
    return line().length() + (is_learning() ? next_waypoint_ + half_width_ : 0.0);
  }
  /// Lateral position for a stopping car, left of the line positive [m]: the middle between `edges`; on a
  /// racing line that line, or the position at `room` from an edge that is nearer.
  [[nodiscard]] double target(const Edges& edges, double room) const noexcept {
    const double middle = 0.5 * (edges.left - edges.right);
    if (!is_raced_ || edges.left + edges.right < 2.0 * room) return middle;
    return std::clamp(0.0, room - edges.right, edges.left - room);
  }
  /// Whether use_line() has set a racing line. line().demand().speed is the planned lap's then.
  [[nodiscard]] bool is_raced() const noexcept { return is_raced_; }
  /// Whether the planned lap slides beyond the peak of the tyres.
  [[nodiscard]] bool slides() const noexcept { return is_raced_ && slides_; }
  /// Number that increases with every new line. Positions along an older line are invalid.
  [[nodiscard]] unsigned revision() const noexcept { return lines_ + (seen_ ? seen_->revision() : 0U); }

 private:
  /// Whether the line is that of the waypoints.
  [[nodiscard]] bool is_learning() const noexcept { return seen_ && !is_raced_; }
  /// Edges of a road from waypoints, relative to a line `offset` [m] left of the waypoints' line.
  [[nodiscard]] Edges assumed_edges(double offset) const noexcept {
    return {half_width_ - offset, half_width_ + offset};
  }
  /// Replaces the line of a closed track by the smooth one that a controller plans from its waypoints.
  void smooth(const RoadData& data, const model::VehicleParams& vehicle);
  /// Edges at a sample of line_, and Here::narrowest from there to the next one.
  struct Room {
    Edges edges;
    Edges narrowest{};
  };
  /// Index of the sample of line_ before s, and the weight of the next one.
  [[nodiscard]] std::pair<std::size_t, double> place(double s) const noexcept;
  /// Fills Room::narrowest of all samples.
  void find_narrowest() noexcept;

  ReferenceLine line_;          ///< line of a track, or racing line
  std::vector<Room> rooms_;     ///< rooms at the samples of line_
  std::optional<Road> seen_;    ///< road learned from waypoints; none on a track
  double half_width_ = 0.0;     ///< distance from the waypoints' line to each edge [m]
  double next_waypoint_ = 0.0;  ///< assumed distance from the last waypoint to the next [m]
  unsigned lines_ = 0;          ///< number of changes of line_
  bool is_raced_ = false;       ///< line_ is a racing line
  bool slides_ = false;         ///< the last racing line slides
};

}  // namespace chicane::road
