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

/// The road that a supervisor knows: its line, and where its edges are. Either a track's, complete from the
/// beginning, or what the waypoints of the measurements have shown so far, with an assumed width. All memory
/// is reserved at construction; one thread.
class KnownRoad {
 public:
  /// Nothing is known, and nothing is learned: for a guard that is off.
  KnownRoad() : line_{2} {}
  /// A track's road. Pre: `data` has at least two points.
  KnownRoad(const road::RoadData& data, const model::VehicleParams& vehicle);
  /// From waypoints; `half_width`: assumed each side of their line [m].
  KnownRoad(double half_width, const model::VehicleParams& vehicle);

  /// Instead of the middle of the road, a line to race by: its places, the room beside it, and the line
  /// itself as target(). On a road from waypoints until reset(), with `half_width` of room each side of their
  /// line. Allocates; null changes nothing.
  void use_line(const RacingRoad* lap);

  void reset() noexcept;
  /// Takes in the waypoints of a measurement; nothing where the track is known.
  void add(const model::Measurement& now) noexcept;

  /// In W; empty while nothing is known.
  [[nodiscard]] const ReferenceLine& line() const noexcept { return is_learning() ? seen_->line() : line_; }
  /// Distances from the line to the edges at s, both positive on the road [m]. Pre: the line is not empty.
  struct Edges {
    double left = 0.0;
    double right = 0.0;
  };
  [[nodiscard]] Edges edges(double s) const noexcept;
  /// Where an open road ends [m]. From waypoints it is assumed to go on, straight, to where the next one
  /// would be, as far as the last two are apart and 25 m at most, and beyond it as far as to its sides.
  [[nodiscard]] double end() const noexcept {
    return line().length() + (is_learning() ? next_waypoint_ + half_width_ : 0.0);
  }
  /// Where a car that has to stop should be: that far to the left of the line, between `edges` [m]. In
  /// the middle of the road, or where a line is raced by on it, but at least `room` from the edges.
  [[nodiscard]] double target(const Edges& edges, double room) const noexcept {
    const double middle = 0.5 * (edges.left - edges.right);
    if (!is_raced_ || edges.left + edges.right < 2.0 * room) return middle;
    return std::clamp(0.0, room - edges.right, edges.left - room);
  }
  /// A line to race by takes the place of the road's own: its demand().speed is that of the planned lap.
  [[nodiscard]] bool is_raced() const noexcept { return is_raced_; }
  /// Whether the lap that is raced by slides beyond the peak of the tyres.
  [[nodiscard]] bool slides() const noexcept { return is_raced_ && slides_; }
  /// Increases with every new line: positions along an older one mean nothing any more.
  [[nodiscard]] unsigned revision() const noexcept { return lines_ + (seen_ ? seen_->revision() : 0U); }

 private:
  [[nodiscard]] bool is_learning() const noexcept { return seen_ && !is_raced_; }
  /// On a road from waypoints, of a line that far to the left of theirs [m].
  [[nodiscard]] Edges assumed_edges(double offset) const noexcept {
    return {half_width_ - offset, half_width_ + offset};
  }
  void smooth(const road::RoadData& data, const model::VehicleParams& vehicle);

  ReferenceLine line_;
  std::vector<Edges> edges_;  ///< at the samples of line_
  std::optional<Road> seen_;
  double half_width_ = 0.0;
  double next_waypoint_ = 0.0;  ///< behind the last one [m]
  unsigned lines_ = 0;
  bool is_raced_ = false;
  bool slides_ = false;  ///< the line that was used last
};

}  // namespace chicane::road
