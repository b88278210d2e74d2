// SPDX-License-Identifier: MIT
// Contract of all controllers: a measurement goes in, a command with its plan and report comes out.
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

/// Estimates of the car from the measurements of the run so far, relative to the configured car. The
/// controllers' models follow the estimates in steps (docs/identification.md).
struct LearnedCar {
  Estimate delay;   ///< delay of commands beyond the configured one [s]
  Estimate gain;    ///< steering gain: wheels turn to gain · command + offset
  Estimate offset;  ///< steering offset [rad]
  Estimate grip;    ///< grip of the tyres, share of the configured grip
};

/// Point of a plan: predicted motion at a moment.
struct PlanPoint {
  double time = 0.0;       ///< clock of the run [s]
  double x = 0.0;          ///< position in W [m]
  double y = 0.0;          ///< position in W [m]
  double psi = 0.0;        ///< yaw in W [rad]
  double speed = 0.0;      ///< along the yaw [m/s]
  model::Command command;  ///< held until the next point
};

/// Plan of a controller: predicted motion with its commands, and the line it follows. Data only.
struct Plan {
  static constexpr int kCapacity = 256;       ///< limit of points: more than the longest horizon has
  int size = 0;                               ///< number of points; 0: no plan
  std::array<PlanPoint, kCapacity> points{};  ///< points[0]: state when the first command acts
  int reference_size = 0;                     ///< number of points of `reference`
  std::array<Vec2, kCapacity> reference{};    ///< reference line in W [m]
};

using road::SpeedLimiter;

/// Explanation of a step: cost by term, limit of the speed, active constraints. Data only. Fields that a
/// controller does not compute keep their default.
struct Explanation {
  static constexpr int kMaxCostTerms = 12;  ///< limit of terms: more than any controller has

  /// Cost of the plan by term, summed over the stages. The first `cost_term_count` have the names of
  /// Controller::cost_terms(); their sum is SolveReport::cost.
  std::array<double, kMaxCostTerms> cost_terms{};
  int cost_term_count = 0;

  SpeedLimiter speed_limiter = SpeedLimiter::kNone;  ///< limit that holds the speed
  /// Allowed speed at the place where the command acts [m/s]; NaN: unknown.
  double speed_limit = std::numeric_limits<double>::quiet_NaN();

  std::uint32_t active_now = 0;    ///< bits of Constraint: active in the first stage of the plan
  std::uint32_t active_ahead = 0;  ///< bits of Constraint: active in any stage of the plan
};

/// Constraints, numbered as bits of Explanation::active_now and as the names of Controller::constraints().
/// Problems without tyres and edges have the first three only.
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
/// Mask of the bit of a constraint.
[[nodiscard]] constexpr std::uint32_t bit(Constraint constraint) noexcept {
  return 1U << static_cast<unsigned>(constraint);
}

/// Names of constraints in the order of Constraint.
inline constexpr std::array<std::string_view, 9> kConstraintNames{
    "steer_limit", "throttle_max", "brake_max", "steer_rate",      "left_edge",
    "right_edge",  "front_tire",   "rear_tire", "friction_ellipse"};
/// Names of constraints of controllers that bound their inputs only.
inline constexpr std::span<const std::string_view> kInputConstraintNames{kConstraintNames.data(), 3};

/// Kind of the result of a step.
enum class Answer : signed char {
  kNone = 0,          ///< no command: the guard falls back on the last plan (safety/guard.hpp)
  kDrive = 1,         ///< the command is the first of the plan
  kStopOnRoad = 2,    ///< no plan: the command stops the car along the known road
  kReturnToRoad = 3,  ///< no plan: the command leads back to the road at walking pace
};

/// Report of one step.
struct StepReport {
  solver::SolveReport solve{.status = solver::SolveStatus::kOptimal};  ///< kOptimal without a solver
  /// Time when the command acts [s], clock of the run; NaN: measurement time plus its delay.
  double act_time = std::numeric_limits<double>::quiet_NaN();
  double lateral_error = 0.0;    ///< offset of the measured position from the line [m], left positive
  double heading_error = 0.0;    ///< measured yaw minus the line's heading [rad]
  double speed_reference = 0.0;  ///< wanted speed at the place where the command acts [m/s]
  double delay = 0.0;            ///< compensated delay from measurement to actuation [s]
  double sight = 0.0;            ///< length of known road ahead [m]
  double solve_time = 0.0;       ///< duration of the solve by the deadline's clock [s]; 0 without a solver
  bool has_map = false;          ///< the learned road is a closed lap
  Explanation explanation;       ///< empty without an answer
  LearnedCar learned;            ///< estimates; grip by a controller that learns it, all others by the guard
};

/// Result of a step.
struct StepResult {
  Answer answer = Answer::kDrive;
  model::Command command;  ///< finite and inside the vehicle's limits; not used with Answer::kNone
  Plan plan;               ///< empty unless the answer is kDrive
  StepReport report;
};

/// Request of a controller for a planned lap on the road, and with the grip, that it has learned.
struct LapRequest {
  bool is_wanted = false;             ///< false: the present lap is kept
  std::span<const Vec2> waypoints{};  ///< learned closed road, in driving order; empty: the known track
  road::LapTerms terms{};             ///< grip, slip and slides to plan with
};

/// Interface of all controllers. If a controller has no answer, safety::Guard decides, in the same way for
/// all.
///
/// step() is noexcept, allocates nothing, takes no lock and reads no clock but the deadline's. It accepts any
/// measurement, also one with NaN or without waypoints. The result stays valid until the next call. One
/// thread; different objects are independent.
class Controller {
 public:
  virtual ~Controller() = default;
  /// Computes the command for a measurement.
  [[nodiscard]] virtual const StepResult& step(const model::Measurement& now, Deadline deadline) noexcept = 0;
  /// Called after each step() with the command that was sent, which may differ from the step's.
  virtual void note_sent(const model::Command& /*command*/) noexcept {}
  /// Sets the planned lap to race by from the next step() on; null: none. Controllers that follow waypoints
  /// ignore it. Allocates nothing.
  virtual void use_line(std::shared_ptr<const road::RacingRoad> /*lap*/) noexcept {}
  /// Request for another planned lap than the present one. Valid until the next step().
  [[nodiscard]] virtual LapRequest wants_lap() const noexcept { return {}; }
  /// Largest lateral distance from the line of `lap` at which the controller is about to drive [m]: the step
  /// that the car has to correct when it changes to that lap. 0: change at once.
  [[nodiscard]] virtual double beside(const road::RacingRoad& /*lap*/) const noexcept { return 0.0; }
  /// Begins a new run: forgets map, estimates and warm start. A planned lap of a track stays, one of a
  /// learned road does not.
  virtual void reset() noexcept = 0;
  [[nodiscard]] virtual std::string_view name() const noexcept = 0;
  /// Names of Explanation's cost terms and of the bits of its active constraints; empty for none.
  [[nodiscard]] virtual std::span<const std::string_view> cost_terms() const noexcept { return {}; }
  [[nodiscard]] virtual std::span<const std::string_view> constraints() const noexcept { return {}; }
};

/// Interface of controllers that can be copied with their whole state: copy and original give the same
/// answers to the same measurements, bit for bit. A run with another controller cannot be copied
/// (run::ClosedLoop::copy()).
class Copyable {
 public:
  [[nodiscard]] virtual std::unique_ptr<Controller> copy() const = 0;

 protected:
  Copyable() = default;
  Copyable(const Copyable&) = default;
  Copyable& operator=(const Copyable&) = default;
  ~Copyable() = default;
};

/// Controller that is Copyable by the copy constructor of `Derived`.
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

/// Interface of controllers whose settings may change while they drive.
template <class Options>
class Tunable {
 public:
  /// Applies settings from the next step() on. Keeps the map, the commands in flight and the last answer as a
  /// first guess. Pre: settings that the make function accepts, and a vehicle of the same name. Allocates
  /// nothing; no slower than a step that learns a new waypoint.
  virtual void configure(const Options& options, const model::VehicleParams& vehicle) noexcept = 0;

 protected:
  ~Tunable() = default;
};

}  // namespace chicane::controller
