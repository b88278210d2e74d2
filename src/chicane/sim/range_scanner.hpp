// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/model/state.hpp"
#include "chicane/road/track.hpp"

/// Simulated planar laser scanners: distances to the walls of a road, or of an occupancy map.

namespace chicane::sim {

/// Geometry of a planar laser scanner. Defaults: the Hokuyo of the F1TENTH car.
struct RangeScannerOptions {
  int beams = 1080;                   ///< [2, 100000]
  double field_of_view = 4.71238898;  ///< angle from the first beam to the last [rad], (0, 2π]
  double range_max = 30.0;            ///< beams that hit nothing nearer report infinity [m], > 0
  double spacing = 0.05;              ///< spacing of the points of a road's walls [m], > 0

  /// Angle from the sensor's x axis to the first beam, on the right [rad].
  [[nodiscard]] double first_angle() const noexcept { return -0.5 * field_of_view; }
  /// Angle between two beams [rad].
  [[nodiscard]] double increment() const noexcept { return field_of_view / (beams - 1); }
};

/// Checks the options. kInvalidArgument if one is out of range.
[[nodiscard]] Result<void> check(const RangeScannerOptions& options);

/// Distances from a point to the walls of a road, which stand along its edges, outside the kerbs. Where a
/// road crosses itself the crossing is open. Immutable after create(): safe from many threads.
///
/// The walls are chords: in a bend of radius R they stand spacing² / 8 R inside of the edge. Nothing else is
/// seen: no other car, no height.
class RangeScanner {
 public:
  /// Creates a scanner of a road. kInvalidArgument for options out of range.
  [[nodiscard]] static Result<RangeScanner> create(const road::Track& track,
                                                   const RangeScannerOptions& options = {});

  /// Distances seen from `sensor` [m], from the first beam on the right to the last on the left, evenly about
  /// its x axis. Pre: ranges.size() == options().beams. Allocates nothing.
  void scan(const model::Pose& sensor, std::span<float> ranges) const noexcept;

  [[nodiscard]] const RangeScannerOptions& options() const noexcept { return options_; }
  /// Angle from the sensor's x axis to the first beam [rad].
  [[nodiscard]] double first_angle() const noexcept { return options_.first_angle(); }
  /// Angle between two beams [rad].
  [[nodiscard]] double increment() const noexcept { return options_.increment(); }
  /// The walls as polylines in W [m], for drawing and tests.
  [[nodiscard]] std::vector<std::vector<Vec2>> walls() const;

 private:
  /// Some consecutive points of a wall, with a circle round them.
  struct Piece {
    std::size_t begin = 0, end = 0;  ///< range in points_; neighbouring pieces share a point
    Vec2 centre{};                   ///< centre of the circle in W [m]
    double radius = 0.0;             ///< radius of the circle [m]
  };

  /// Adds the wall on one side of the road: 1 left, -1 right.
  void add_wall(const road::Track& track, double side);
  /// Adds the points from `begin` on, one wall without a gap, as pieces.
  void add_pieces(std::size_t begin);
  /// Lowers the ranges of the beams that hit a wall through `points` nearer than before.
  void draw(std::span<const Vec2> points, const model::Pose& sensor, std::span<float> ranges) const noexcept;

  RangeScannerOptions options_;
  std::vector<Vec2> points_;  ///< points of all walls in W [m]
  std::vector<Piece> pieces_;
  std::vector<Vec2> directions_;  ///< directions of the beams in the sensor's frame
};

/// A map of square cells that are wall or free, seen from above.
struct OccupancyGrid {
  static constexpr std::size_t kMostCells = 64'000'000;  ///< limit of cells: bounds memory; chosen

  int width = 0, height = 0;       ///< [cells], > 0, at most kMostCells in all
  double resolution = 0.05;        ///< side of a cell [m], > 0
  model::Pose origin{};            ///< pose of the first cell's lower left corner; rows go along its x axis
  std::vector<bool> is_wall = {};  ///< row by row, the lowest row first
};

/// Distances from a point to the walls of an occupancy map. Exact: a beam ends where it enters the first cell
/// that is wall. Beams that leave the map hit nothing. Immutable after create(): safe from many threads.
///
/// Memory: one byte for each cell, which holds the size of the free square around it, so that a beam crosses
/// free room in large steps.
class MapScanner {
 public:
  /// Creates a scanner of a map. kInvalidArgument for options out of range, or a grid with inconsistent
  /// numbers.
  [[nodiscard]] static Result<MapScanner> create(const OccupancyGrid& grid,
                                                 const RangeScannerOptions& options = {});

  /// Scans like RangeScanner::scan(). Zero within a wall. Allocates nothing.
  void scan(const model::Pose& sensor, std::span<float> ranges) const noexcept;
  /// Whether a place in W is in a cell that is wall.
  [[nodiscard]] bool is_wall(const Vec2& place) const noexcept;

  [[nodiscard]] const RangeScannerOptions& options() const noexcept { return options_; }

 private:
  /// Position in cells from the origin of a place in W.
  [[nodiscard]] Vec2 in_cells(const Vec2& place) const noexcept;
  /// Distance along a unit vector to the first wall [cells]; infinite without one.
  [[nodiscard]] double cast(const Vec2& from, const Vec2& direction) const noexcept;
  /// Fills room_, which holds 0 for walls and the largest value for free cells.
  void measure_free_room();
  /// Index of a cell in room_.
  [[nodiscard]] std::size_t at(int x, int y) const noexcept {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  RangeScannerOptions options_;
  int width_ = 0, height_ = 0;      ///< size of the map [cells]
  double resolution_ = 0.0;         ///< side of a cell [m]
  model::Pose origin_{};            ///< OccupancyGrid::origin
  Vec2 axis_{1.0, 0.0};             ///< direction of the rows in W
  std::vector<std::uint8_t> room_;  ///< 0: wall; n: the cells up to n - 1 columns and rows away are free
  std::vector<Vec2> directions_;    ///< directions of the beams in the sensor's frame
};

}  // namespace chicane::sim
