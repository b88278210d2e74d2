// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string_view>

#include "chicane/base/deadline.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/controller/guard_words.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/reference_line.hpp"
#include "chicane/solver/solution.hpp"

namespace chicane::road {
class RacingRoad;
}
namespace chicane::controller {

/// A quantity that is estimated while the car drives.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();      ///< NaN: not estimated
  double deviation = std::numeric_limits<double>::quiet_NaN();  ///< standard deviation
};

/// Estimates of the car by the measurements of a run so far, relative to the configured car. Models follow
/// them in steps (docs/identification.md).
struct LearnedCar {
  Estimate delay;   ///< delay of commands beyond the configured one [s]
  Estimate gain;    ///< steering gain: wheels turn to gain · command + offset
  Estimate offset;  ///< steering offset [rad]
  Estimate grip;    ///< grip of the tyres, share of the configured grip
};

/// One predicted moment.
struct PlanPoint {
  double time = 0.0;       ///< [s], clock of the run
  double x = 0.0;          ///< position in W [m]
  double y = 0.0;          ///< position in W [m]
  double psi = 0.0;        ///< [rad]
  double speed = 0.0;      ///< [m/s]
  model::Command command;  ///< held from this moment to the next point's
};

/// Plan of a controller: predicted motion with its commands, and the line it follows. Data only.
struct Plan {
  static constexpr int kCapacity = 256;       ///< limit of points
  int size = 0;                               ///< points in use; 0 = no plan
  std::array<PlanPoint, kCapacity> points{};  ///< points[0] is where the first command acts
  int reference_size = 0;
  std::array<Vec2, kCapacity> reference{};  ///< reference line in W [m]
};

using road::SpeedLimiter;

/// Explanation of a step: cost by term, limits of speed, active constraints. Plain data, filled once per
/// step; fields that a controller does not compute keep their default.
struct Explanation {
  static constexpr int kMaxCostTerms = 12;

  /// Cost of the plan by term, summed over the stages: the first `cost_term_count` have the
  /// names of Controller::cost_terms(). Together they are SolveReport::cost.
  std::array<double, kMaxCostTerms> cost_terms{};
  int cost_term_count = 0;

  SpeedLimiter speed_limiter = SpeedLimiter::kNone;
  /// Allowed speed at the place where the command acts [m/s]; NaN: unknown.
  double speed_limit = std::numeric_limits<double>::quiet_NaN();

  /// One bit each, in the order of Controller::constraints(): active in the first stage of the plan, and in
  /// any.
  std::uint32_t active_now = 0;
  std::uint32_t active_ahead = 0;
};

/// Constraints, numbered as bits of Explanation::active_now. Problems without tyres and edges have the first
/// three only.
enum class Constraint : std::uint8_t {
  kSteerLimit,
  kThrottleMax,
  kBrakeMax,
  kSteerRate,
  kLeftEdge,
  kRightEdge,
  kFrontTire,
  kRearTire,
  kFrictionEllipse,
};
[[nodiscard]] constexpr std::uint32_t bit(Constraint constraint) noexcept {
  return 1U << static_cast<unsigned>(constraint);
}

/// Names of constraints in the order of Constraint.
inline constexpr std::array<std::string_view, 9> kConstraintNames{
    "steer_limit", "throttle_max", "brake_max", "steer_rate",      "left_edge",
    "right_edge",  "front_tire",   "rear_tire", "friction_ellipse"};
/// Names of constraints of controllers that bound their inputs only.
inline constexpr std::span<const std::string_view> kInputConstraintNames{kConstraintNames.data(), 3};

/// Kind of a step's result.
enum class Answer : signed char {
  kNone = 0,          ///< no command: the guard falls back on the last plan (safety/guard.hpp)
  kDrive = 1,         ///< the command is the first of the plan
  kStopOnRoad = 2,    ///< no plan: the command stops the car along the known road
  kReturnToRoad = 3,  ///< no plan: the command leads back to the road at walking pace
};

/// Report of one step.
struct StepReport {
  solver::SolveReport solve{.status = solver::SolveStatus::kOptimal};  ///< default without a solver
  /// Time when the command acts [s], clock of the run; NaN: measurement time plus its delay.
  double act_time = std::numeric_limits<double>::quiet_NaN();
  double lateral_error = 0.0;    ///< offset of the measured position from the line [m], left positive
  double heading_error = 0.0;    ///< measured yaw minus the line's heading [rad]
  double speed_reference = 0.0;  ///< wanted at the point where the command acts [m/s]
  double delay = 0.0;            ///< compensated: from measurement to actuation [s]
  double sight = 0.0;            ///< length of known road ahead [m]
  double solve_time = 0.0;  ///< time of the optimisation alone [s], by the deadline's clock; 0 without one
  bool has_map = false;     ///< the learned road is a closed lap
  Explanation explanation;  ///< empty without an answer
  LearnedCar learned;       ///< grip: the controller's word, where it learns that; the rest: the guard's
};

struct StepResult {
  Answer answer = Answer::kDrive;
  model::Command command;  ///< finite and inside the vehicle's limits; without meaning for Answer::kNone
  Plan plan;               ///< empty for any answer but kDrive
  StepReport report;
};

/// Request of a controller for a planned lap, by the road and grip that it has learned.
struct LapRequest {
  bool is_wanted = false;
  std::span<const Vec2> waypoints{};  ///< learned closed road, in driving order; empty: the known track
  road::LapTerms terms{};
};

/// The contract every controller fulfils: a measurement goes in, an answer or none comes out. Without an
/// answer safety::Guard decides, in the same way for all controllers.
///
/// step() is noexcept, allocates nothing, takes no lock and reads no clock but the deadline's. It accepts any
/// measurement, also one with NaN or without waypoints. The result stays valid until the next call. One
/// thread; different objects are independent.
class Controller {
 public:
  virtual ~Controller() = default;
  [[nodiscard]] virtual const StepResult& step(const model::Measurement& now, Deadline deadline) noexcept = 0;
  /// Called after each step() with the command that was sent, which may differ from the step's.
  virtual void note_sent(const model::Command& /*command*/) noexcept {}
  /// Sets the planned lap to race by from the next step() on; null: none. Controllers that follow waypoints
  /// ignore it. Allocates nothing.
  virtual void use_line(std::shared_ptr<const road::RacingRoad> /*lap*/) noexcept {}
  /// Request for another planned lap than the present one. Valid until step().
  [[nodiscard]] virtual LapRequest wants_lap() const noexcept { return {}; }
  /// Lateral distance from `lap` [m] at which the controller is about to drive, and which it corrects if it
  /// takes the lap up now. 0: take it up at once.
  [[nodiscard]] virtual double beside(const road::RacingRoad& /*lap*/) const noexcept { return 0.0; }
  /// Begins a new run: forgets map, estimates and warm start. A planned lap of a track stays, one of a
  /// learned road does not.
  virtual void reset() noexcept = 0;
  [[nodiscard]] virtual std::string_view name() const noexcept = 0;
  /// Names of Explanation's cost terms and of the bits of its active constraints; empty for none.
  [[nodiscard]] virtual std::span<const std::string_view> cost_terms() const noexcept { return {}; }
  [[nodiscard]] virtual std::span<const std::string_view> constraints() const noexcept { return {}; }
};

/// Interface of controllers, beside Controller, that can be copied with their whole state: both give the same
/// answers to the same measurements from then on, bit for bit. A run with a controller that is not Copyable
/// cannot be copied (run::ClosedLoop::copy()).
class Copyable {
 public:
  [[nodiscard]] virtual std::unique_ptr<Controller> copy() const = 0;

 protected:
  Copyable() = default;
  Copyable(const Copyable&) = default;
  Copyable& operator=(const Copyable&) = default;
  ~Copyable() = default;
};

/// A controller that is Copyable by the copy constructor of `Derived`.
template <class Derived>
class CopyableController : public Controller, public Copyable {
 public:
  [[nodiscard]] std::unique_ptr<Controller> copy() const final {
    return std::make_unique<Derived>(static_cast<const Derived&>(*this));
  }
};

/// Copy of a controller; null if it is not Copyable.
[[nodiscard]] inline std::unique_ptr<Controller> copy_of(const Controller& controller) {
  const auto* copyable = dynamic_cast<const Copyable*>(&controller);
  return copyable == nullptr ? nullptr : copyable->copy();
}

/// Interface of controllers, beside Controller, whose settings may change while they drive.
template <class Options>
class Tunable {
 public:
  /// Applies settings from the next step() on. Map, commands in flight and the last answer as a start are
  /// kept. Pre: settings that the make function accepts, of the same vehicle by name. Allocates nothing; no
  /// slower than a step that learns a new waypoint.
  virtual void configure(const Options& options, const model::VehicleParams& vehicle) noexcept = 0;

 protected:
  ~Tunable() = default;
};

}  // namespace chicane::controller
