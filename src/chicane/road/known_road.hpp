// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/road/reference_line.hpp"
#include "chicane/road/road.hpp"
#include "chicane/road/track.hpp"

namespace chicane::road {

/// The road that a supervisor knows: its line and its edges. Either a track's, complete from the beginning,
/// or learned from the waypoints of measurements, with an assumed width. All memory is reserved at
/// construction; one thread.
class KnownRoad {
 public:
  /// No road, and none is learned: for a guard that is off.
  KnownRoad() : line_{2} {}
  /// A track's road. Pre: `data` has at least two points.
  KnownRoad(const road::RoadData& data, const model::VehicleParams& vehicle);
  /// A road learned from waypoints; `half_width`: assumed from their line to each edge [m].
  KnownRoad(double half_width, const model::VehicleParams& vehicle);

  /// Replaces the middle of the road by a planned racing line: line(), edges() and target() are the plan's.
  /// On a road from waypoints until reset(), with edges `half_width` from the waypoints' line. Allocates;
  /// null changes nothing.
  void use_line(const RacingRoad* lap);

  void reset() noexcept;
  /// Learns the waypoints of a measurement; does nothing on a track.
  void add(const model::Measurement& now) noexcept;

  /// Line in W; empty while no road is known.
  [[nodiscard]] const ReferenceLine& line() const noexcept { return is_learning() ? seen_->line() : line_; }
  /// Distances from the line to the edges at s, both positive on the road [m]. Pre: the line is not empty.
  struct Edges {
    double left = 0.0;
    double right = 0.0;
  };
  [[nodiscard]] Edges edges(double s) const noexcept;
  /// End of an open road [m]. A road from waypoints is assumed to continue straight to the next waypoint (as
  /// far as the last two are apart, at most 25 m), and beyond it by half its width.
  [[nodiscard]] double end() const noexcept {
    return line().length() + (is_learning() ? next_waypoint_ + half_width_ : 0.0);
  }
  /// Lateral place for a car that stops, left of the line positive, between `edges` [m]: the middle of the
  /// road, or the racing line, at least `room` from the edges.
  [[nodiscard]] double target(const Edges& edges, double room) const noexcept {
    const double middle = 0.5 * (edges.left - edges.right);
    if (!is_raced_ || edges.left + edges.right < 2.0 * room) return middle;
    return std::clamp(0.0, room - edges.right, edges.left - room);
  }
  /// Whether use_line() has set a racing line; demand().speed is the planned lap's then.
  [[nodiscard]] bool is_raced() const noexcept { return is_raced_; }
  /// Whether the planned lap slides beyond the peak of the tyres.
  [[nodiscard]] bool slides() const noexcept { return is_raced_ && slides_; }
  /// Number that increases with every new line. Positions along an older line are invalid.
  [[nodiscard]] unsigned revision() const noexcept { return lines_ + (seen_ ? seen_->revision() : 0U); }

 private:
  [[nodiscard]] bool is_learning() const noexcept { return seen_ && !is_raced_; }
  /// Edges of a road from waypoints, seen from a line `offset` [m] left of theirs.
  [[nodiscard]] Edges assumed_edges(double offset) const noexcept {
    return {half_width_ - offset, half_width_ + offset};
  }
  void smooth(const road::RoadData& data, const model::VehicleParams& vehicle);

  ReferenceLine line_;
  std::vector<Edges> edges_;  ///< edges at the samples of line_
  std::optional<Road> seen_;
  double half_width_ = 0.0;
  double next_waypoint_ = 0.0;  ///< assumed distance from the last waypoint to the next [m]
  unsigned lines_ = 0;          ///< number of lines so far
  bool is_raced_ = false;
  bool slides_ = false;  ///< whether the last racing line slides
};

}  // namespace chicane::road
