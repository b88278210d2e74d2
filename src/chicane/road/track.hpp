// SPDX-License-Identifier: MIT
// Track: a road as a reference line with the distances to its edges, made from raw points; its corners.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/road/path.hpp"

namespace chicane::road {

/// Cross-section of a road, as files have it.
struct TrackPoint {
  Vec2 position{};     ///< point of the reference line in W [m]
  double left = 0.0;   ///< distance to the left edge of the drivable surface [m], > 0
  double right = 0.0;  ///< distance to the right edge [m], > 0
};

/// Options for turning raw points into a road.
struct TrackOptions {
  double spacing = 2.0;  ///< spacing of the line's knots [m]; [0.05, 10]; reduced where the points demand it
  /// Expected noise of the points [m], about which the smoothed line stays near them; [0, 1].
  double smoothing_sigma = 0.1;
  double kerb_width = 0.0;  ///< drivable kerb outside each edge [m]; touching it is not off-track; [0, 3]
  double start_s = 0.0;     ///< start of a car along the line [m]; wrapped when closed
  double start_d = 0.0;     ///< start of a car across the line, left positive [m]; within the road
  double finish_s = 0.0;    ///< end of timing on an open road, along the line [m]; 0: its end
};

/// Road: a reference line with the distances to its edges, open or closed. Immutable after create(), so that
/// many threads may use it at once; references it returns are valid as long as it lives.
///
/// The line is a smooth one through the raw points (docs/tracks.md). Where it leaves a raw point by d, the
/// widths change by d, so that the edges stay where the points have them. s = 0 is at the first raw point.
class Track {
 public:
  /// Fails with kInvalidArgument and the index of the point, counted from 0, for: fewer than 4 different
  /// points, non-finite numbers, widths <= 0 or > 1 km, gaps > 10 km, a point as far from the smooth line as
  /// from its edge, a line that crosses itself at less than 30 degrees or again within four widths of the
  /// road; also for options out of range. 100,000 points take less than a second.
  [[nodiscard]] static Result<Track> create(std::string name, const std::vector<TrackPoint>& points,
                                            bool closed, const TrackOptions& options = {});

  /// Road enlarged `factor` > 0 times, for cars of that scale.
  [[nodiscard]] Track scaled(double factor) const;

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const Path& centre() const noexcept { return centre_; }
  [[nodiscard]] double length() const noexcept { return centre_.length(); }
  /// Distance from the line to the edge at arc length s [m] (any s; wrapped when closed, clamped when open).
  [[nodiscard]] double left_width(double s) const noexcept { return width_at(left_, s); }
  [[nodiscard]] double right_width(double s) const noexcept { return width_at(right_, s); }
  [[nodiscard]] double kerb_width() const noexcept { return kerb_width_; }
  /// Number of crossings of the road with itself, at grade: 1 for a figure of eight.
  [[nodiscard]] int crossings() const noexcept { return crossings_; }
  /// Distance to the nearer edge of the road at the projection's s [m]: positive on the road, negative beyond
  /// the edge.
  [[nodiscard]] double edge_distance(const Projection& foot) const noexcept;
  /// Points as given, before smoothing. Telemetry sends the next six of them as waypoints.
  [[nodiscard]] const std::vector<TrackPoint>& raw_points() const noexcept { return raw_points_; }
  /// Arc length of each raw point on the line [m].
  [[nodiscard]] const std::vector<double>& raw_places() const noexcept { return raw_places_; }
  /// Start of a car along the line [m], in whose direction it stands.
  [[nodiscard]] double start_s() const noexcept { return start_s_; }
  /// Start of a car across the line [m], left positive.
  [[nodiscard]] double start_d() const noexcept { return start_d_; }
  /// Length of a lap [m]: once round a closed road, or from start to finish of an open one.
  [[nodiscard]] double lap_length() const noexcept { return lap_length_; }

 private:
  Track(std::string name, Path centre) : name_{std::move(name)}, centre_{std::move(centre)} {}
  /// Computes the tables of widths, and raw_places_; `guesses`: about the arc length of each point [m].
  void set_widths(const std::vector<TrackPoint>& points, const std::vector<double>& guesses);
  /// Error of the first point that is not on the road: the line leaves it by the distance to its edge or
  /// more.
  [[nodiscard]] std::optional<Error> check_fit(const std::vector<TrackPoint>& points) const;
  [[nodiscard]] double width_at(const std::vector<double>& table, double s) const noexcept;

  std::string name_;
  Path centre_;
  int crossings_ = 0;
  double kerb_width_ = 0.0;
  double start_s_ = 0.0;
  double start_d_ = 0.0;
  double lap_length_ = 0.0;
  double width_spacing_ = 1.0;  ///< spacing of the tables of widths [m]
  std::vector<double> left_;    ///< widths [m] at s = k · width_spacing_, the last at s = length
  std::vector<double> right_;   ///< likewise to the right edge
  std::vector<TrackPoint> raw_points_;
  std::vector<double> raw_places_;
};

/// Distances of raw points from the smooth line [m].
struct PointFit {
  double rms = 0.0;   ///< root mean square
  double most = 0.0;  ///< largest one
};

/// Distances of a track's raw points from its line.
[[nodiscard]] inline PointFit point_fit(const Track& track) {
  const std::size_t count = std::min(track.raw_points().size(), track.raw_places().size());
  PointFit fit;
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double away =
        (track.centre().at(track.raw_places()[i]).position - track.raw_points()[i].position).norm();
    sum += away * away;
    fit.most = std::max(fit.most, away);
  }
  fit.rms = std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, count)));
  return fit;
}

/// Corner of a road. Its positions are arc lengths of the road's line [m], within one lap.
struct Corner {
  double begin = 0.0;
  double apex = 0.0;  ///< point of the largest curvature
  double end = 0.0;   ///< less than `begin` where the corner crosses s = 0 of a closed road
  double turn = 0.0;  ///< change of heading from begin to end [rad], left positive
};

/// Corners of a track in the order in which a lap from the start line meets their apexes; at most
/// `kMostCorners`.
///
/// A corner is a stretch of curvature above 1/220 m, averaged over 14 m, on which the road turns by 0.3 rad
/// or more. Bends to the same side with less than 20 m between them are one corner. For roads narrower than 6
/// m on average, which are models, these lengths are smaller in proportion. The dashboard finds the same
/// corners (web/src/state/corners.ts). Allocates.
[[nodiscard]] std::vector<Corner> corners_of(const Track& track);
inline constexpr int kMostCorners = 128;

/// Ends of the sectors of a lap, one to each corner, as distances from the start line [m]: half-way along the
/// straight to the next corner, the last one at the end of the lap. Empty without corners. Allocates.
[[nodiscard]] std::vector<double> corner_sectors(const Track& track, const std::vector<Corner>& corners);

}  // namespace chicane::road
