// SPDX-License-Identifier: MIT
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

/// The cones of the severe double lane change of ISO 3888-2: an entry lane, a side lane to the left with 1 m
/// between the two, an exit lane in line with the entry lane, as wide as the car makes them, and 13.5 m and
/// 12.5 m between them. x runs along the course from the entry, y to the left from the entry lane's middle
/// (docs/measured/racing.md).
class LaneChangeCourse {
 public:
  struct Lane {
    double begin = 0.0, end = 0.0;   ///< x [m]
    double right = 0.0, left = 0.0;  ///< y of its cones [m]
  };
  static constexpr double kLength = 61.0;   ///< [m]
  static constexpr double kStart = 80.0;    ///< distance before the entry at which the car waits [m]
  static constexpr double kRunUp = 100.0;   ///< length of road before the entry [m]
  static constexpr double kRunOut = 200.0;  ///< length of road behind the exit [m]

  /// Course for a car of this width [m].
  explicit LaneChangeCourse(double width) noexcept;

  [[nodiscard]] const std::array<Lane, 3>& lanes() const noexcept { return lanes_; }
  /// y of a smooth line through [m].
  [[nodiscard]] double way(double x) const noexcept;
  /// Least distance of a body of this length and width to the nearest cones [m], which count as walls;
  /// negative: a cone is hit. Infinite outside the lanes. `car`: pose of the middle between the axles.
  [[nodiscard]] double room(const model::Pose& car, double length, double width) const noexcept;
  /// Course as an open road along that line: edges at the cones, as wide as the entry lane before the entry,
  /// and wide where there are none.
  [[nodiscard]] Result<road::Track> road() const;

 private:
  std::array<Lane, 3> lanes_;
};

struct LaneChangeOutcome {
  double entry_speed = 0.0;                               ///< speed of the centre of mass at the entry [m/s]
  double exit_speed = 0.0;                                ///< speed at the exit; 0: it was not reached
  double room = std::numeric_limits<double>::infinity();  ///< least [m]; negative: a cone was hit
  [[nodiscard]] bool has_passed() const noexcept { return exit_speed > 0.0 && !(room < 0.0); }
};

struct LaneChangeLimit {
  int passed_kmph = 0;       ///< highest entry speed that was passed with all below; 0: none
  LaneChangeOutcome passed;  ///< outcome at that speed
  LaneChangeOutcome failed;  ///< 1 km/h above it
};

/// The severe double lane change (docs/measured/racing.md), for all controllers of one car. Each gets the
/// same line: the fastest way through for a car whose grip just allows the speed of the run. A racing
/// controller also gets the cones. Lines are planned once, in steps of 5 km/h. Deterministic.
class LaneChange {
 public:
  static constexpr int kSlowest = 30;  ///< [km/h]
  static constexpr int kFastest = 200;

  /// Creates the lane change of a car. kInvalidArgument for a model car; otherwise fails as
  /// lap_time::plan_racing_line().
  [[nodiscard]] static Result<LaneChange> create(const model::VehicleParams& vehicle);

  /// Drives it once: the speed [m/s] is held up to 2 m behind the entry, where the throttle is released for
  /// good; the scenario's controller steers, with its latency, sampling and noise, and knows that it has no
  /// pedals. The guard is off: it would brake. Fails as ClosedLoop::create(). Pre: it is of this vehicle.
  [[nodiscard]] Result<LaneChangeOutcome> drive(const scenario::Scenario& scenario, double speed,
                                                const Factories& make = {});
  /// Tries speeds in steps of 1 km/h from kSlowest on, up to the first at which a cone is hit.
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
  double full_speed_ = 0.0;  ///< mean speed in the course with all of the grip [m/s]
  std::map<int, Way> ways_;  ///< lines by speed, in steps
};

}  // namespace chicane::run
