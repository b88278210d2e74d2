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

namespace chicane::sim {

/// A planar laser scanner. Defaults: the Hokuyo of the F1TENTH car.
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
  /// Some consecutive points of a wall, in a circle.
  struct Piece {
    std::size_t begin = 0, end = 0;  ///< range in points_; a point belongs to the pieces on both of its sides
    Vec2 centre{};
    double radius = 0.0;
  };

  void add_wall(const road::Track& track, double side);
  void add_pieces(std::size_t begin);
  void draw(std::span<const Vec2> points, const model::Pose& sensor, std::span<float> ranges) const noexcept;

  RangeScannerOptions options_;
  std::vector<Vec2> points_;
  std::vector<Piece> pieces_;
  std::vector<Vec2> directions_;  ///< directions of the beams in the sensor's frame
};

/// A map of square cells that are wall or free, seen from above.
struct OccupancyGrid {
  static constexpr std::size_t kMostCells = 64'000'000;

  int width = 0, height = 0;       ///< [cells], > 0, at most kMostCells in all
  double resolution = 0.05;        ///< side of a cell [m], > 0
  model::Pose origin{};            ///< pose of the first cell's lower left corner; rows go along its x axis
  std::vector<bool> is_wall = {};  ///< row by row, the lowest row first
};

/// Distances from a point to the walls of an occupancy map. Exact: a beam ends where it enters the first cell
/// that is wall. Outside of the map is nothing. Immutable after create(): safe from many threads.
///
/// A byte for each cell: how many cells around it are free, so that a beam takes free room in large steps.
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
  [[nodiscard]] Vec2 in_cells(const Vec2& place) const noexcept;
  [[nodiscard]] double cast(const Vec2& from, const Vec2& direction) const noexcept;
  void measure_free_room();
  [[nodiscard]] std::uint8_t& room(int x, int y) noexcept {
    return room_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                 static_cast<std::size_t>(x)];
  }
  [[nodiscard]] std::uint8_t room(int x, int y) const noexcept {
    return room_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                 static_cast<std::size_t>(x)];
  }

  RangeScannerOptions options_;
  int width_ = 0, height_ = 0;
  double resolution_ = 0.0;
  model::Pose origin_{};
  Vec2 axis_{1.0, 0.0};             ///< direction of the rows in W
  std::vector<std::uint8_t> room_;  ///< 0: wall; n: all cells less than n away, diagonals too, are free
  std::vector<Vec2> directions_;    ///< directions of the beams in the sensor's frame
};

}  // namespace chicane::sim
