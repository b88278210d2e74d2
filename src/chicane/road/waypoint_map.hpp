// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "chicane/base/vec2.hpp"
#include "chicane/model/measurement.hpp"

namespace chicane::road {

/// The road as a car learns it: the waypoints of all measurements so far in driving order, closed into a loop
/// as soon as the first one is seen again. Telemetry repeats waypoints exactly, so two closer than kSame are
/// one.
///
/// Memory for kCapacity waypoints is reserved at construction; add() allocates nothing. A measurement whose
/// waypoints match nothing known starts a new map (another scene, or a car that was moved), and so does one
/// that no longer fits.
class WaypointMap {
 public:
  static constexpr int kCapacity = 4096;
  static constexpr double kSame = 0.3;  ///< [m]

  WaypointMap();
  void clear() noexcept;
  /// Takes in the waypoints of a measurement. True when the map changed.
  [[nodiscard]] bool add(const model::Measurement& now) noexcept;

  [[nodiscard]] std::span<const Vec2> points() const noexcept { return points_; }
  [[nodiscard]] bool is_closed() const noexcept { return is_closed_; }
  /// Index of the first waypoint of the last measurement that showed one known.
  [[nodiscard]] int first_seen() const noexcept { return hint_; }
  /// Increases when the map is begun anew.
  [[nodiscard]] unsigned generation() const noexcept { return generation_; }

 private:
  enum class Loop { kOpen, kClosed, kUndecided };
  [[nodiscard]] Loop closes(std::span<const Vec2> seen, std::size_t i) const noexcept;
  [[nodiscard]] int find(const Vec2& point) const noexcept;

  std::vector<Vec2> points_;
  bool is_closed_ = false;
  unsigned generation_ = 0;
  int hint_ = 0;  ///< index where the last measurement's first waypoint was found
};

}  // namespace chicane::road
