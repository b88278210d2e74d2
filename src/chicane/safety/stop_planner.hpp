// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/model/prediction.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/known_road.hpp"
#include "chicane/safety/stop_plan.hpp"

namespace chicane::safety {

/// Where a stop begins, in coordinates along a line.
struct StopStart {
  double time = 0.0;  ///< [s], clock of the run
  double s = 0.0;     ///< along the line [m]
  double d = 0.0;     ///< beside it, left positive [m]
  double e = 0.0;     ///< yaw minus the line's heading [rad]
  model::BodyMotion<double> body{};
};

/// How a stop comes out.
struct StopCheck {
  double least_edge = 0.0;  ///< of the outermost contact patch to the believed edge [m]; < 0: off the road
  double distance = 0.0;    ///< to standstill [m]
  bool stands = false;      ///< it ends at standstill before the end of the known road
};

/// How hard a stop may brake.
struct Braking {
  double share = 0.8;      ///< of the useful braking, (0, 1]
  double stability = 1.6;  ///< least static stability that it leaves (PredictionModel::stability)
};

/// Plans the stop along a line: path-following steering and as much braking as the curve leaves, simulated
/// with the car the controller believes in until it stands (docs/safety.md, eq. 1–5). The plan and the check
/// come from the same simulation. Bounded time, about 25 µs for a stop from 45 m/s; no allocation; one
/// thread.
class StopPlanner {
 public:
  explicit StopPlanner(const model::VehicleParams& vehicle) noexcept
      : model_{vehicle}, softer_{vehicle}, stiffer_{vehicle} {
    set_vehicle(vehicle);
  }
  void set_vehicle(const model::VehicleParams& vehicle) noexcept;

  /// The stop from `start` on, no harder than `braking`. Pre: the road is not
  /// empty, `start` is finite.
  [[nodiscard]] StopCheck plan(const road::KnownRoad& road, const StopStart& start, const Braking& braking,
                               StopPlan& out) const noexcept;
  /// How near to the edge [m] a receiver comes in the first `time` [s] that plays `stop` blindly, the car
  /// being a little other than believed: its rear axle softer while it turns in more than estimated, and
  /// stiffer while it turns in less.
  [[nodiscard]] double played_edge(const road::KnownRoad& road, const StopStart& start, const StopPlan& stop,
                                   double time) const noexcept;
  /// `command` for `time` [s] from `from` on: where the car is then, and how near to the edge it came.
  [[nodiscard]] StopStart advance(const road::KnownRoad& road, const StopStart& from,
                                  const model::Command& command, double time,
                                  double& least_edge) const noexcept;
  /// The law: the command of a stop at `at`.
  [[nodiscard]] model::Command law(const road::KnownRoad& road, const StopStart& at,
                                   const Braking& braking) const noexcept;
  /// Of the outermost contact patch to the believed edge [m].
  [[nodiscard]] double edge(const road::KnownRoad& road, const StopStart& at) const noexcept;

 private:
  [[nodiscard]] double instability(model::BodyMotion<double> m, double deceleration) const noexcept;
  [[nodiscard]] double stable_share(const model::BodyMotion<double>& m, double deceleration,
                                    double stability) const noexcept;
  [[nodiscard]] double braking_share(double sideways, double deceleration, double v) const noexcept;
  static void move(const model::PredictionModel& model, const road::KnownRoad& road, StopStart& at,
                   const model::Command& command, double dt,
                   const model::PredictionModel::Lags& lags) noexcept;

  model::PredictionModel model_;
  model::PredictionModel softer_, stiffer_;  ///< the car as it may be, too
  double friction_ = 0.0;                    ///< sideways, of the whole car
};

}  // namespace chicane::safety
