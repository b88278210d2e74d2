// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/model/state.hpp"
#include "chicane/sim/range_scanner.hpp"

namespace chicane::sim {

/// A map of square cells that are wall or free, seen from above.
struct OccupancyGrid {
  static constexpr std::size_t kMostCells = 64'000'000;

  int width = 0, height = 0;       ///< [cells], > 0, at most kMostCells in all
  double resolution = 0.05;        ///< side of a cell [m], > 0
  model::Pose origin{};            ///< of the lower left corner of the first cell; rows go along its x axis
  std::vector<bool> is_wall = {};  ///< row by row, the lowest row first
};

/// Distances from a point to the walls of an occupancy map. Exact: a beam ends where it enters the first cell
/// that is wall. Outside of the map is nothing. Immutable after create(): safe from many threads.
///
/// A byte for each cell: how many cells around it are free, so that a beam takes free room in large steps.
class MapScanner {
 public:
  /// kInvalidArgument for options out of range, or a grid whose numbers do not fit each other.
  [[nodiscard]] static Result<MapScanner> create(const OccupancyGrid& grid,
                                                 const RangeScannerOptions& options = {});

  /// As RangeScanner::scan(). Zero within a wall. Allocates nothing.
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
  Vec2 axis_{1.0, 0.0};             ///< of the rows, in W
  std::vector<std::uint8_t> room_;  ///< 0: wall; n: all cells less than n away, diagonals too, are free
  std::vector<Vec2> directions_;    ///< of the beams, in the sensor's frame
};

}  // namespace chicane::sim
