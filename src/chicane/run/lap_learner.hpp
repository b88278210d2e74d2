// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/base/vec2.hpp"
#include "chicane/model/state.hpp"
#include "chicane/sim/world.hpp"

namespace chicane::run {

/// Times the laps of a car on a road that is not known: its start line is the straight line across the car
/// where it was first seen, kReach to each side. A lap counts when the car crosses that line again in the
/// same direction, after kLeast of way and 90 % of the first lap's; crossing back and forth counts for
/// nothing. What would need the road stays unknown: place, edges, sectors.
///
/// Between two sightings the car is taken to go evenly. Allocates nothing, cannot fail. One thread.
class LapLearner {
 public:
  static constexpr double kReach = 15.0;  ///< [m]
  static constexpr double kLeast = 50.0;  ///< way of a lap [m]

  /// A new run from wherever the car is seen next.
  void reset() noexcept;
  /// Time rises from sighting to sighting; `speed` [m/s] tells a car that drives from one that was moved: the
  /// running lap of the latter begins where it is.
  void see(double time, const model::Pose& car, double speed) noexcept;

  /// Laps and their times; all else at its default.
  [[nodiscard]] const sim::WorldState& state() const noexcept { return state_; }

 private:
  void start(double time, const model::Pose& car) noexcept;
  void cross_line(double crossing) noexcept;
  void count_lap(double crossing) noexcept;

  sim::WorldState state_;
  bool has_line_ = false;
  Vec2 line_{0.0, 0.0};
  Vec2 direction_{1.0, 0.0};  ///< in which the line is crossed
  Vec2 last_{0.0, 0.0};
  int backward_ = 0;         ///< crossings that have to be made up for
  double lap_start_ = 0.0;   ///< [s]
  double driven_ = 0.0;      ///< since the line was crossed [m]
  double lap_length_ = 0.0;  ///< of the first lap [m]; 0: none yet
};

}  // namespace chicane::run
