// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "chicane/model/prediction.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/known_road.hpp"
#include "chicane/safety/stop_car.hpp"
#include "chicane/safety/stop_player.hpp"

namespace chicane::safety {

/// Where a stop begins, in coordinates along a line.
struct StopStart {
  double time = 0.0;  ///< [s], clock of the run
  double s = 0.0;     ///< along the line [m]
  double d = 0.0;     ///< beside it, left positive [m]
  double e = 0.0;     ///< yaw minus the line's heading [rad]
  model::BodyMotion<double> body{};
  double load_along = 0.0, load_across = 0.0;    ///< as in StopMotion [m/s²]
  double behind_front = 0.0, behind_rear = 0.0;  ///< as in StopMotion [rad]
};

/// The result of a simulated stop.
struct StopCheck {
  double least_edge = 0.0;  ///< of the outermost contact patch to the assumed edge [m]; < 0: off the road
  double distance = 0.0;    ///< to standstill [m]
  bool stands = false;      ///< it ends at standstill before the end of the known road, without a spin
  double spins_at = 0.0;    ///< speed at which the car begins to spin [m/s]; 0: it does not
  StopStart end{};          ///< where the simulation ended
};

/// How hard a stop may brake (docs/guard.md, eq. 5). Chosen; `foreseen` is off at 1e9.
struct Braking {
  double share = 0.8;      ///< of the useful braking, (0, 1]
  double stability = 1.6;  ///< least static stability that it leaves (model/stability.hpp)
  double foreseen = 1e9;   ///< the same where the bends ahead ask for harder braking
};

/// A way to standstill with the feedback that holds it: along the planned lap until `until`, then braking by
/// the law, equation (3) with these constants. Chosen: the calmest law of the family (docs/guard.md).
struct Policy {
  double until = -std::numeric_limits<double>::infinity();  ///< [s], clock of the run
  Braking braking{};
  double bandwidth = 1.0;   ///< of the feedback to the line [rad/s]
  double grip_share = 0.4;  ///< of the grip that the feedback may use
  double room = 0.6;        ///< wanted to the edge along a planned lap [m]
  double hold = 0.1;        ///< time for which its command is held: a control cycle [s]
};

/// By how much the state at which a stop begins may differ from the predicted one.
struct Doubt {
  double beside = 0.0;    ///< [m]
  double course = 0.0;    ///< [rad]
  double yaw_rate = 0.0;  ///< [rad/s]
  double speed = 0.0;     ///< [m/s]
};

/// The worse of two cars that differ a little from the model.
struct DoubtCheck {
  double edge_for = 0.0;  ///< least distance to the edge in a given time [m]
  double edge = 0.0;      ///< and until both have ended [m]
  double speed = 0.0;     ///< at which one came nearer to the edge than allowed; 0: none did [m/s]
  bool stands = true;     ///< both end at standstill on the known road, without a spin
};

/// Simulates stops along a line: path-following steering and as much braking as the curve leaves, in the
/// model of the car, until it stands (docs/guard.md, eq. 1–5). Bounded time, tens of µs for a
/// stop from 45 m/s; no allocation; one thread.
class StopPlanner {
 public:
  explicit StopPlanner(const model::VehicleParams& vehicle) noexcept
      : model_{vehicle}, car_{vehicle}, softer_{vehicle}, stiffer_{vehicle} {
    set_vehicle(vehicle);
  }
  void set_vehicle(const model::VehicleParams& vehicle) noexcept;
  /// Whether the car is simulated with its four wheels (StopCar), and so closer than an estimate counts on.
  [[nodiscard]] bool has_wheels() const noexcept { return car_.has_wheels(); }

  static constexpr double kToTheEnd = -1e9;  ///< [m] a least edge below which no car comes
  /// The stop from `start` on by `policy`; given up, and so without standstill, where it comes nearer to the
  /// edge than `least` [m]. Pre: the road is not empty, `start` is finite.
  [[nodiscard]] StopCheck plan(const road::KnownRoad& road, const StopStart& start, const Policy& policy,
                               StopPlan& out, double least = kToTheEnd) const noexcept;
  /// The same policy, with its feedback, in two cars that differ from the model: less friction, the rear axle
  /// softer and stiffer, and `doubt` to either side (eq. 5b). Given up where one comes nearer than `least`
  /// [m]; distances to the edge above it are returned as `least`.
  [[nodiscard]] DoubtCheck plan_in_doubt(const road::KnownRoad& road, const StopStart& start,
                                         const Policy& policy, const Doubt& doubt,
                                         double least) const noexcept;
  /// The same two cars, driven by a receiver that plays `stop` without measurements; edge_for: in the first
  /// `time` [s]. Distances to the edge above `enough` >= 0 [m] are returned as `enough`, in less time.
  [[nodiscard]] DoubtCheck played(const road::KnownRoad& road, const StopStart& start, const StopPlan& stop,
                                  double time,
                                  double enough = std::numeric_limits<double>::infinity()) const noexcept;
  /// `command` for `time` [s] from `from` on: where the car is then, and how near to the edge it came.
  [[nodiscard]] StopStart advance(const road::KnownRoad& road, const StopStart& from,
                                  const model::Command& command, double time,
                                  double& least_edge) const noexcept;
  /// The command of `policy` at `at`.
  [[nodiscard]] model::Command command(const road::KnownRoad& road, const StopStart& at,
                                       const Policy& policy) const noexcept {
    return command(road, at, road.here(at.s), policy);
  }
  /// The acceleration [m/s²], negative, of a stop by `braking`: what the bend, and a car that shall stay
  /// stable, leave of the braking. A car of much drag may need its drive for that.
  [[nodiscard]] double slowing(const road::KnownRoad& road, const StopStart& at,
                               const Braking& braking) const noexcept {
    return slowing(road, at, braking, curvatures_of(road, at, road.here(at.s), {}));
  }
  static constexpr double kCreep = 1.0;  ///< [m/s] of a car that turns beside an edge
  /// The command of a car that creeps: its speed `vx` [m/s] approaches kCreep.
  [[nodiscard]] model::Command creep(double steer, double vx) const noexcept {
    return {steer, throttle_for(model_.vehicle(), kCreepDrive * std::max(kCreep - vx, 0.0), vx)};
  }
  /// The way of a car that creeps with its wheels turned.
  struct Arc {
    double steer = 0.0;       ///< road-wheel angle [rad]
    double hold = 0.0;        ///< time for which its command may act [s]
    double doubt = 0.0;       ///< by which the arc beyond a stop may be predicted off the road [m]
    bool goes_round = false;  ///< it turns the long way, and has to get along the road
  };
  /// Whether a car that creeps from `at` on stays inside the edges until it is along the road or as far from
  /// the edge as before (eq. 6c). It comes to rest on its arc wherever it is stopped.
  [[nodiscard]] bool creeps_inside(const road::KnownRoad& road, StopStart at, const Arc& arc) const noexcept;
  /// How much nearer to the edge [m] a car comes that stands at `at` and turns back along the road at full
  /// lock: equation 6a. 0: no nearer.
  [[nodiscard]] double turning_room(const road::KnownRoad& road, const StopStart& at) const noexcept;
  /// Of the outermost contact patch to the assumed edge [m].
  [[nodiscard]] double edge(const road::KnownRoad& road, const StopStart& at) const noexcept {
    return least_edge(road, at, road.here(at.s), std::numeric_limits<double>::infinity());
  }

 private:
  using Here = road::KnownRoad::Here;
  // Chosen: a plan has a point for each Policy::hold, and 128 of them: 12.8 s.
  static constexpr double kStep = 0.05;       ///< [s] of the simulation
  static constexpr double kCreepDrive = 2.5;  ///< [1/s] of creeping: turned wheels resist
  static constexpr int kStepsPerPoint = 2;    ///< of the simulation, in the plan
  /// Steps of the simulation in which a command is held.
  [[nodiscard]] static int held_steps(const Policy& policy) noexcept {
    return std::max(kStepsPerPoint, static_cast<int>(std::lround(policy.hold / kStep)));
  }
  /// Curvatures at a place of a stop [1/m].
  struct Curvatures {
    double here = 0.0;    ///< of the line
    double ahead = 0.0;   ///< of the line, a moment later
    double wanted = 0.0;  ///< the same, and what brings the car back to the line
  };
  // The same at a place whose `here` was looked up before.
  [[nodiscard]] model::Command command(const road::KnownRoad& road, const StopStart& at, const Here& here,
                                       const Policy& policy) const noexcept;
  [[nodiscard]] double least_edge(const road::KnownRoad& road, const StopStart& at, const Here& here,
                                  double least) const noexcept;
  [[nodiscard]] Curvatures curvatures_of(const road::KnownRoad& road, const StopStart& at, const Here& here,
                                         const Policy& policy) const noexcept;
  [[nodiscard]] double slowing(const road::KnownRoad& road, const StopStart& at, const Braking& braking,
                               const Curvatures& curvatures) const noexcept;
  [[nodiscard]] double instability(const model::BodyMotion<double>& m, double deceleration) const noexcept;
  [[nodiscard]] double stable_share(const model::BodyMotion<double>& m, double deceleration, double stability,
                                    double at_all) const noexcept;
  [[nodiscard]] double raced_slowing(const road::KnownRoad& road, const StopStart& at) const noexcept;
  [[nodiscard]] double foreseen(const road::KnownRoad& road, const StopStart& at, double most) const noexcept;
  [[nodiscard]] double left_sideways(double bend, double turning, double v) const noexcept;
  [[nodiscard]] double braking_share(double sideways, double deceleration, double v) const noexcept;
  template <class Law>
  [[nodiscard]] DoubtCheck in_doubt(const road::KnownRoad& road, const StopStart& start, const Doubt& doubt,
                                    double time, double least, double enough,
                                    const Law& command_at) const noexcept;
  [[nodiscard]] double back_to(double beside, double course, double v, const Policy& policy,
                               double damping) const noexcept;
  static void move(const StopCar& car, const Here& here, StopStart& at, const model::Command& command,
                   const StopCar::Step& step, double steer_reach) noexcept;
  [[nodiscard]] double steer_reach(double dt) const noexcept;

  model::PredictionModel model_;
  StopCar car_;               ///< that is stopped
  StopCar softer_, stiffer_;  ///< cars that differ from the model: by their rear axle
  double doubt_ = 1.0;        ///< share of the differences that counts
  double friction_ = 0.0;     ///< sideways, of the whole car
};

}  // namespace chicane::safety
