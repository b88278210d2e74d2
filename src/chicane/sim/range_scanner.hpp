// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/model/state.hpp"
#include "chicane/road/track.hpp"

namespace chicane::sim {

/// A planar laser scanner. Defaults: the Hokuyo of the F1TENTH car.
struct RangeScannerOptions {
  int beams = 1080;                   ///< [2, 100000]
  double field_of_view = 4.71238898;  ///< from the first beam to the last [rad], (0, 2π]
  double range_max = 30.0;            ///< beams that hit nothing nearer report infinity [m], > 0
  double spacing = 0.05;              ///< between the points of the walls of a road [m], > 0

  /// From the sensor's x axis to the first beam, on the right [rad].
  [[nodiscard]] double first_angle() const noexcept { return -0.5 * field_of_view; }
  /// Between two beams [rad].
  [[nodiscard]] double increment() const noexcept { return field_of_view / (beams - 1); }
};

/// kInvalidArgument for options out of range.
[[nodiscard]] Result<void> check(const RangeScannerOptions& options);

/// Distances from a point to the walls of a road, which stand along its edges, outside the kerbs. Where a
/// road crosses itself the crossing is open. Immutable after create(): safe from many threads.
///
/// The walls are chords: in a bend of radius R they stand spacing² / 8 R inside of the edge. Nothing else is
/// seen: no other car, no height.
class RangeScanner {
 public:
  /// kInvalidArgument for options out of range.
  [[nodiscard]] static Result<RangeScanner> create(const road::Track& track,
                                                   const RangeScannerOptions& options = {});

  /// Distances seen from `sensor` [m], from the first beam on the right to the last on the left, evenly about
  /// its x axis. Pre: ranges.size() == options().beams. Allocates nothing.
  void scan(const model::Pose& sensor, std::span<float> ranges) const noexcept;

  [[nodiscard]] const RangeScannerOptions& options() const noexcept { return options_; }
  /// From the sensor's x axis to the first beam [rad].
  [[nodiscard]] double first_angle() const noexcept { return options_.first_angle(); }
  /// Between two beams [rad].
  [[nodiscard]] double increment() const noexcept { return options_.increment(); }
  /// The walls as polylines in W [m], for drawing and tests.
  [[nodiscard]] std::vector<std::vector<Vec2>> walls() const;

 private:
  /// Some consecutive points of a wall, in a circle.
  struct Piece {
    std::size_t begin = 0, end = 0;  ///< of points_; a point belongs to the pieces on both of its sides
    Vec2 centre{};
    double radius = 0.0;
  };

  void add_wall(const road::Track& track, double side);
  void add_pieces(std::size_t begin);
  void draw(std::span<const Vec2> points, const model::Pose& sensor, std::span<float> ranges) const noexcept;

  RangeScannerOptions options_;
  std::vector<Vec2> points_;
  std::vector<Piece> pieces_;
  std::vector<Vec2> directions_;  ///< of the beams, in the sensor's frame
};

}  // namespace chicane::sim
