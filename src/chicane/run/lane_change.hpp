// SPDX-License-Identifier: MIT
// Severe double lane change of ISO 3888-2: its course, and the highest entry speed that a controller passes.
#pragma once

#include <array>
#include <limits>
#include <map>
#include <memory>

#include "chicane/base/result.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/road/track.hpp"
#include "chicane/run/make.hpp"
#include "chicane/scenario/scenario.hpp"

namespace chicane::run {

/// Cones of the severe double lane change of ISO 3888-2 (docs/measured/racing.md): an entry lane, a side lane
/// 1 m to the left of it, and an exit lane in line with the entry lane, with 13.5 m and 12.5 m between them.
/// Lane widths follow from the car's. x runs along the course from the entry, y to the left from the middle
/// of the entry lane.
class LaneChangeCourse {
 public:
  struct Lane {
    double begin = 0.0, end = 0.0;   ///< x of both ends [m]
    double right = 0.0, left = 0.0;  ///< y of its cones [m]
  };
  static constexpr double kLength = 61.0;   ///< length of the course [m], by the standard
  static constexpr double kStart = 80.0;    ///< distance before the entry at which a run begins [m]; chosen
  static constexpr double kRunUp = 100.0;   ///< length of road before the entry [m]; chosen
  static constexpr double kRunOut = 200.0;  ///< length of road behind the exit [m]; chosen

  /// Course for a car of this width [m].
  explicit LaneChangeCourse(double width) noexcept;

  [[nodiscard]] const std::array<Lane, 3>& lanes() const noexcept { return lanes_; }
  /// y of a smooth line through the lanes at `x` [m].
  [[nodiscard]] double way(double x) const noexcept;
  /// Least distance of a body of this length and width to the cones of a lane [m], which count as walls;
  /// negative: a cone is hit. Infinite outside the lanes. `car`: pose of the middle between the axles.
  [[nodiscard]] double room(const model::Pose& car, double length, double width) const noexcept;
  /// Course as an open road along way(): edges at the cones, as wide as the entry lane before the entry, and
  /// wide elsewhere.
  [[nodiscard]] Result<road::Track> road() const;

 private:
  std::array<Lane, 3> lanes_;
};

/// Result of one run through the course.
struct LaneChangeOutcome {
  double entry_speed = 0.0;                               ///< speed of the centre of mass at the entry [m/s]
  double exit_speed = 0.0;                                ///< speed at the exit; 0: it was not reached
  double room = std::numeric_limits<double>::infinity();  ///< least LaneChangeCourse::room() [m]
  [[nodiscard]] bool has_passed() const noexcept { return exit_speed > 0.0 && !(room < 0.0); }
};

/// Highest entry speed that a controller passes.
struct LaneChangeLimit {
  int passed_kmph = 0;       ///< highest speed that was passed, with all lower ones [km/h]; 0: none
  LaneChangeOutcome passed;  ///< outcome at that speed
  LaneChangeOutcome failed;  ///< outcome at 1 km/h more
};

/// The severe double lane change (docs/measured/racing.md) with one car, for any controller. All controllers
/// follow the same line: the fastest one for a car whose grip just allows the speed of the run. A racing
/// controller also knows the cones. Lines are planned once, in steps of 5 km/h. Deterministic.
class LaneChange {
 public:
  static constexpr int kSlowest = 30;   ///< lowest entry speed that is tried [km/h]; chosen
  static constexpr int kFastest = 200;  ///< highest entry speed that is tried [km/h]; chosen

  /// Creates the lane change of a car. kInvalidArgument for a model car; otherwise fails as
  /// lap_time::plan_racing_line().
  [[nodiscard]] static Result<LaneChange> create(const model::VehicleParams& vehicle);

  /// Drives the course once. The `speed` [m/s] is held up to 2 m behind the entry, where the throttle is
  /// released. The scenario's controller steers, with its latency, sampling and noise; its model has no
  /// pedals. The guard is off, because it would brake. Fails as ClosedLoop::create(). Pre: the scenario has
  /// the vehicle of create().
  [[nodiscard]] Result<LaneChangeOutcome> drive(const scenario::Scenario& scenario, double speed,
                                                const Factories& make = {});
  /// Tries speeds in steps of 1 km/h from kSlowest on, up to the first at which a cone is hit.
  [[nodiscard]] Result<LaneChangeLimit> find_limit(const scenario::Scenario& scenario,
                                                   const Factories& make = {});

 private:
  using Way = std::shared_ptr<const road::RacingRoad>;

  LaneChange(const model::VehicleParams& vehicle, const LaneChangeCourse& course, road::Track road)
      : vehicle_{vehicle}, course_{course}, road_{std::move(road)} {}
  /// Fastest line through the course with a share of the car's grip, in (0, 1].
  [[nodiscard]] Result<road::RacingLine> plan(double grip_share) const;
  /// Line for a run at `speed` [m/s], planned before or now.
  [[nodiscard]] Result<Way> way_at(double speed);

  model::VehicleParams vehicle_;
  LaneChangeCourse course_;
  road::Track road_;         ///< the course as a road
  double full_speed_ = 0.0;  ///< mean speed in the course with the whole grip [m/s]
  std::map<int, Way> ways_;  ///< planned lines by speed, in steps of 5 km/h
};

}  // namespace chicane::run
