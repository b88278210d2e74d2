// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/path/path.hpp"

namespace chicane::path {

/// One cross-section of a road as files give it.
struct TrackPoint {
  Vec2 position = Vec2::Zero();  ///< centre-line point in W [m]
  double left = 0.0;             ///< distance to the left edge of the drivable surface [m], > 0
  double right = 0.0;            ///< distance to the right edge [m], > 0
};

/// How raw points become a road.
struct TrackOptions {
  double spacing = 2.0;  ///< of the resampled knots [m]; [0.5, 10]
  double smoothing_sigma =
      0.1;  ///< expected noise of the points [m]; the smoothed line stays within about this; [0, 1]
  double kerb_width = 0.0;  ///< drivable kerb outside each edge [m]; touching it is not off-track; [0, 3]
};

/// A road: a reference line with the distances to its edges, open or closed. Immutable after create().
class Track {
 public:
  /// Fails with kInvalidArgument and the index of the point for: fewer than 4 points, non-finite numbers,
  /// coincident neighbours only, widths <= 0, a line that crosses itself. 100,000 points take less than a
  /// second.
  [[nodiscard]] static Result<Track> create(std::string name, const std::vector<TrackPoint>& points,
                                            bool closed, const TrackOptions& options = {});

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const Path& centre() const noexcept { return centre_; }
  /// Distance from the line to the edge at arc length s [m] (any s; wrapped when closed).
  [[nodiscard]] double left_width(double s) const noexcept;
  [[nodiscard]] double right_width(double s) const noexcept;
  [[nodiscard]] double kerb_width() const noexcept { return kerb_width_; }
  /// The waypoints as given (before smoothing), which telemetry sends six of.
  [[nodiscard]] const std::vector<TrackPoint>& raw_points() const noexcept { return raw_points_; }

 private:
  Track(std::string name, Path centre) : name_{std::move(name)}, centre_{std::move(centre)} {}

  std::string name_;
  Path centre_;
  double kerb_width_ = 0.0;
  double width_spacing_ = 1.0;
  std::vector<double> left_;
  std::vector<double> right_;
  std::vector<TrackPoint> raw_points_;
};

}  // namespace chicane::path
