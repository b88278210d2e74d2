// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <map>
#include <memory>

#include "chicane/base/result.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/run/lane_change_course.hpp"
#include "chicane/run/make.hpp"
#include "chicane/scenario/scenario.hpp"

namespace chicane::run {

struct LaneChangeOutcome {
  double entry_speed = 0.0;  ///< of the centre of mass where the course begins [m/s]
  double exit_speed = 0.0;   ///< and where it ends; 0: it was not reached
  double room = std::numeric_limits<double>::infinity();  ///< least [m]; negative: a cone was hit
  [[nodiscard]] bool has_passed() const noexcept { return exit_speed > 0.0 && !(room < 0.0); }
};

struct LaneChangeLimit {
  int passed_kmph = 0;       ///< highest entry speed that was passed with all below; 0: none
  LaneChangeOutcome passed;  ///< at that speed
  LaneChangeOutcome failed;  ///< 1 km/h above it
};

/// The severe double lane change (docs/tracks.md), for those who drive one car. All are shown the same line:
/// the fastest way through of a car whose grip lets it go just so fast as the car of the run; one that races
/// knows the cones, too. Lines are planned once, in steps of 5 km/h. Deterministic.
class LaneChange {
 public:
  static constexpr int kSlowest = 30;  ///< [km/h]
  static constexpr int kFastest = 200;

  /// kInvalidArgument for a model car, and as lap_time::plan_racing_line().
  [[nodiscard]] static Result<LaneChange> create(const model::VehicleParams& vehicle);

  /// Drives it once: the speed [m/s] is held up to 2 m behind the entry, where the throttle is released for
  /// good; the scenario's controller steers, with its latency, sampling and noise, and knows that it has no
  /// pedals. The guard is off: it would brake. Fails as ClosedLoop::create(). Pre: it is of this vehicle.
  [[nodiscard]] Result<LaneChangeOutcome> drive(const scenario::Scenario& scenario, double speed,
                                                const Factories& make = {});
  /// In steps of 1 km/h from kSlowest on, up to the first at which a cone is hit.
  [[nodiscard]] Result<LaneChangeLimit> find_limit(const scenario::Scenario& scenario,
                                                   const Factories& make = {});

 private:
  using Way = std::shared_ptr<const road::RacingRoad>;

  LaneChange(const model::VehicleParams& vehicle, const LaneChangeCourse& course, road::Track road)
      : vehicle_{vehicle}, course_{course}, road_{std::move(road)} {}
  [[nodiscard]] Result<road::RacingLine> plan(double grip_share) const;
  [[nodiscard]] Result<Way> way_at(double speed);

  model::VehicleParams vehicle_;
  LaneChangeCourse course_;
  road::Track road_;
  double full_speed_ = 0.0;  ///< with all of the grip, mean in the course [m/s]
  std::map<int, Way> ways_;  ///< by speed, in steps
};

}  // namespace chicane::run
