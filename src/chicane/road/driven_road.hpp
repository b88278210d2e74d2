// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <utility>

#include "chicane/model/measurement.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/road/reference_line.hpp"
#include "chicane/road/road.hpp"

namespace chicane::road {

/// The road that a controller drives on: what waypoints show of it, or a planned lap to race by. A lap that
/// was planned for the road as learned from waypoints is given up where those are of another road. Allocates
/// at construction only; one thread.
class DrivenRoad {
 public:
  DrivenRoad(const RoadOptions& options, const model::VehicleParams& vehicle) : seen_{options, vehicle} {}
  void configure(const RoadOptions& options, const model::VehicleParams& vehicle) noexcept {
    seen_.configure(options, vehicle);
  }

  /// A lap to race by from now on; null: the waypoints.
  void race_by(std::shared_ptr<const RacingRoad> lap) noexcept {
    lap_ = std::move(lap);
    ++laps_;
  }
  [[nodiscard]] bool is_raced() const noexcept { return lap_ != nullptr; }

  /// Takes in the waypoints of a measurement, where they tell anything. False when a learned lap had to be
  /// given up.
  [[nodiscard]] bool add(const model::Measurement& now) noexcept {
    if (!is_raced() || is_learned()) seen_.add(now);
    if (!is_learned() || !seen_.closed_waypoints().empty()) return true;
    race_by(nullptr);
    return false;
  }
  /// Forgets the waypoints, and a lap that was planned from them.
  void reset() noexcept {
    if (is_learned()) race_by(nullptr);
    seen_.reset();
  }

  /// In W; empty while nothing is known.
  [[nodiscard]] const ReferenceLine& line() const noexcept { return lap_ ? lap_->line() : seen_.line(); }
  /// Changes with every other line: positions along an older one mean nothing any more.
  [[nodiscard]] unsigned revision() const noexcept { return seen_.revision() + laps_; }
  /// The planned lap; null: none.
  [[nodiscard]] const RacingRoad* lap() const noexcept { return lap_.get(); }
  /// Road::room() and Road::closed_waypoints() of the road as seen.
  [[nodiscard]] const Road& seen() const noexcept { return seen_; }

 private:
  [[nodiscard]] bool is_learned() const noexcept { return lap_ && lap_->is_learned(); }

  Road seen_;
  std::shared_ptr<const RacingRoad> lap_;
  unsigned laps_ = 0;
};

}  // namespace chicane::road
