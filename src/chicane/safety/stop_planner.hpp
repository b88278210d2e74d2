// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <memory>

#include "chicane/controller/controller.hpp"
#include "chicane/model/prediction.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/known_road.hpp"
#include "chicane/safety/stop_car.hpp"
#include "chicane/safety/stop_plan.hpp"

namespace chicane::safety {

/// Where a stop begins, in coordinates along a line.
struct StopStart {
  double time = 0.0;  ///< [s], clock of the run
  double s = 0.0;     ///< along the line [m]
  double d = 0.0;     ///< beside it, left positive [m]
  double e = 0.0;     ///< yaw minus the line's heading [rad]
  model::BodyMotion<double> body{};
  double load_along = 0.0, load_across = 0.0;  ///< as in StopMotion [m/s²]
};

/// How a stop comes out.
struct StopCheck {
  double least_edge = 0.0;  ///< of the outermost contact patch to the believed edge [m]; < 0: off the road
  double distance = 0.0;    ///< to standstill [m]
  bool stands = false;      ///< it ends at standstill before the end of the known road, without a spin
  double spins_at = 0.0;    ///< speed at which the car begins to spin [m/s]; 0: it does not
};

/// A stop, and where the car is at each of its points.
struct StopCourse {
  StopPlan stop;
  std::array<StopStart, StopPlan::kCapacity> places{};

  /// One more point, of a car that is at `place` after `distance` [m]; nothing where it is full.
  void add(const StopStart& place, double distance, double speed, const model::Command& command) noexcept {
    if (stop.size == StopPlan::kCapacity) return;
    const auto i = static_cast<std::size_t>(stop.size++);
    stop.points[i] = {place.time, distance, speed, command};
    places[i] = place;
  }
};

[[nodiscard]] inline std::unique_ptr<StopCourse> copy_of(const StopCourse& course) {
  return std::make_unique<StopCourse>(course);
}

/// How hard a stop may brake.
struct Braking {
  double share = 0.8;      ///< of the useful braking, (0, 1]
  double stability = 1.6;  ///< least static stability that it leaves (PredictionModel::stability)
  double foreseen = 1e9;   ///< the same where the bends ahead ask for harder braking
};

/// How a stop comes out that is played blindly by a car that is a little other than believed.
struct BlindCheck {
  double edge_for = 0.0;  ///< least distance to the edge in the time asked for [m]
  double edge = 0.0;      ///< until it stands, or leaves the road later [m]
  double speed = 0.0;     ///< at which it left the road later; 0: it did not [m/s]
};

/// Plans the stop along a line: path-following steering and as much braking as the curve leaves, simulated
/// with the car the controller believes in until it stands (docs/safety_derivation.md, eq. 1–5). The plan and
/// the check come from the same simulation. Bounded time, tens of µs for a stop from 45 m/s; no allocation;
/// one thread.
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
  /// The stop from `start` on, no harder than `braking`; given up, and so without standstill, where it comes
  /// nearer to the edge than `least` [m]. Pre: the road is not empty, `start` is finite.
  [[nodiscard]] StopCheck plan(const road::KnownRoad& road, const StopStart& start, const Braking& braking,
                               StopCourse& out, double least = kToTheEnd) const noexcept;
  /// From `start` on along another stop: its commands by place, corrected where the car is not as planned
  /// there, and the law where it ends. Pre: as plan(), before.stop.size > 0.
  [[nodiscard]] StopCheck follow(const road::KnownRoad& road, const StopStart& start,
                                 const StopCourse& before, StopCourse& out) const noexcept;
  /// The first `longest` [s] of the motion that a controller publishes, in coordinates along the line: a
  /// course to drive on along. Pre: as plan().
  void course_of(const road::KnownRoad& road, const StopStart& start, const controller::Plan& intended,
                 double longest, StopCourse& out) const noexcept;
  /// Drives on along `intended` for `time` [s], then brakes by the law. Pre: as plan(); intended.stop.size
  /// > 1.
  [[nodiscard]] StopCheck plan_later(const road::KnownRoad& road, const StopStart& start,
                                     const StopCourse& intended, double time, const Braking& braking,
                                     StopCourse& out, double least = kToTheEnd) const noexcept;
  static constexpr double kLongestDriveOn = 3.0;  ///< [s]
  /// How near to the edge [m] a receiver comes in the first `time` [s] that plays `stop` blindly, the car
  /// being a little other than believed: its rear axle softer while it turns in more than estimated, and
  /// stiffer while it turns in less.
  [[nodiscard]] BlindCheck played_edge(const road::KnownRoad& road, const StopStart& start,
                                       const StopPlan& stop, double time) const noexcept;
  /// The same of a car that is seen all the time: until it stands, with what brings it back to the stop.
  /// Pre: `stop` begins at `start`.
  [[nodiscard]] double followed_edge(const road::KnownRoad& road, const StopStart& start,
                                     const StopCourse& stop) const noexcept;
  /// `command` for `time` [s] from `from` on: where the car is then, and how near to the edge it came.
  [[nodiscard]] StopStart advance(const road::KnownRoad& road, const StopStart& from,
                                  const model::Command& command, double time,
                                  double& least_edge) const noexcept;
  /// The law: the command of a stop at `at`.
  [[nodiscard]] model::Command law(const road::KnownRoad& road, const StopStart& at,
                                   const Braking& braking) const noexcept;
  /// And its acceleration [m/s²], negative: what the bend, and a car that shall stay stable, leave of the
  /// braking. A car of much drag may need its drive for that.
  [[nodiscard]] double slowing(const road::KnownRoad& road, const StopStart& at,
                               const Braking& braking) const noexcept {
    return slowing(road, at, braking, curvatures_of(road, at));
  }
  /// How much nearer to the edge [m] a car comes that stands at `at` and turns back along the road at full
  /// lock: equation 6a. 0: no nearer.
  [[nodiscard]] double turning_room(const road::KnownRoad& road, const StopStart& at) const noexcept;
  /// Of the outermost contact patch to the believed edge [m].
  [[nodiscard]] double edge(const road::KnownRoad& road, const StopStart& at) const noexcept;

 private:
  /// Curvatures at a place of a stop [1/m].
  struct Curvatures {
    double ahead = 0.0;   ///< of the line, a moment later
    double wanted = 0.0;  ///< the same, and what brings the car back to the line
  };
  [[nodiscard]] Curvatures curvatures_of(const road::KnownRoad& road, const StopStart& at) const noexcept;
  [[nodiscard]] double slowing(const road::KnownRoad& road, const StopStart& at, const Braking& braking,
                               const Curvatures& curvatures) const noexcept;
  [[nodiscard]] double instability(const model::BodyMotion<double>& m, double deceleration) const noexcept;
  [[nodiscard]] double stable_share(const model::BodyMotion<double>& m, double deceleration,
                                    double stability) const noexcept;
  [[nodiscard]] double raced_slowing(const road::KnownRoad& road, const StopStart& at) const noexcept;
  [[nodiscard]] double foreseen(const road::KnownRoad& road, const StopStart& at, double most) const noexcept;
  [[nodiscard]] double braking_share(double sideways, double deceleration, double v) const noexcept;
  template <class Law>
  [[nodiscard]] BlindCheck doubted_edge(const road::KnownRoad& road, const StopStart& start, double time,
                                        const Law& command_at) const noexcept;
  template <class Law>
  [[nodiscard]] StopCheck drive(const road::KnownRoad& road, const StopStart& start, const Law& command_at,
                                StopCourse& out, double least = kToTheEnd) const noexcept;
  [[nodiscard]] model::Command along(const StopCourse& before, std::size_t& place, double lap,
                                     const StopStart& at) const noexcept;
  [[nodiscard]] double back_to(double beside, double course, double v, double damping) const noexcept;
  static void move(const StopCar& car, const road::KnownRoad& road, StopStart& at,
                   const model::Command& command, const StopCar::Step& step, double steer_reach) noexcept;
  [[nodiscard]] double steer_reach(double dt) const noexcept;

  model::PredictionModel model_;
  StopCar car_;               ///< that is stopped
  StopCar softer_, stiffer_;  ///< and as it may be, too
  double doubt_ = 1.0;        ///< how much other
  double friction_ = 0.0;     ///< sideways, of the whole car
};

}  // namespace chicane::safety
