// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string_view>

#include "chicane/base/deadline.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/controller/explanation.hpp"
#include "chicane/controller/guard_words.hpp"
#include "chicane/controller/learned_car.hpp"
#include "chicane/controller/plan.hpp"
#include "chicane/model/measurement.hpp"
#include "chicane/model/state.hpp"
#include "chicane/solver/solution.hpp"

namespace chicane::road {
class RacingRoad;
}

namespace chicane::controller {

/// What a controller's step came to.
enum class Answer : signed char {
  kNone = 0,          ///< no command: the guard falls back on the last plan (safety/guard.hpp)
  kDrive = 1,         ///< the command is the first of the plan
  kStopOnRoad = 2,    ///< no plan: the command stops the car along the known road
  kReturnToRoad = 3,  ///< no plan: the command leads back to the road at walking pace
};

/// How one step went.
struct StepReport {
  solver::SolveReport solve{.status = solver::SolveStatus::kOptimal};  ///< as it is where nothing is solved
  double act_time = std::numeric_limits<double>::quiet_NaN();  ///< when the command acts [s], clock of the
                                                               ///< run; NaN: measurement time plus its delay
  double lateral_error = 0.0;    ///< of the measured position from the reference line [m], left positive
  double heading_error = 0.0;    ///< measured yaw minus the line's heading [rad]
  double speed_reference = 0.0;  ///< wanted at the point where the command acts [m/s]
  double delay = 0.0;            ///< compensated: from measurement to actuation [s]
  double sight = 0.0;            ///< length of known road ahead [m]
  double solve_time = 0.0;  ///< of the optimisation alone [s], as the deadline's clock saw it; 0 without one
  bool has_map = false;     ///< the lap is closed in memory
  Explanation explanation;  ///< why the answer is what it is; empty without an answer
  LearnedCar learned;       ///< grip: the controller's word, where it learns that; the rest: the guard's
};

struct StepResult {
  Answer answer = Answer::kDrive;
  model::Command command;  ///< finite and inside the vehicle's limits; without meaning for Answer::kNone
  Plan plan;               ///< empty for any answer but kDrive
  StepReport report;
};

/// A lap that a controller wants to be planned, from what it has learned of road and grip.
struct LapWish {
  bool is_wanted = false;
  std::span<const Vec2> waypoints{};  ///< of the closed road that was learned, in driving order; empty: the
                                      ///< track's, which is known
  double grip = 1.0;                  ///< over the one that the vehicle's parameters tell
  bool slides = false;                ///< beyond the peak of the tyres, where that is stable
};

/// The contract every controller fulfils: a measurement goes in, an answer or none comes out. What happens
/// without an answer is not the controller's concern: safety::Guard decides it, for all controllers alike.
///
/// step() is noexcept, allocates nothing, takes no lock and reads no clock but the deadline's. It accepts any
/// measurement, also one with NaN or without waypoints. The result stays valid until the next call. One
/// thread; different objects are independent.
class Controller {
 public:
  virtual ~Controller() = default;
  [[nodiscard]] virtual const StepResult& step(const model::Measurement& now, Deadline deadline) noexcept = 0;
  /// After each step(): what was really sent, which may be another command than the step's.
  virtual void note_sent(const model::Command& /*command*/) noexcept {}
  /// A planned lap to race by from the next step() on; null: none any more. Controllers that follow the
  /// waypoints do not care. Allocates nothing.
  virtual void use_line(std::shared_ptr<const road::RacingRoad> /*lap*/) noexcept {}
  /// The lap to race by that the controller would rather have than what it drives by. Valid until step().
  [[nodiscard]] virtual LapWish wants_lap() const noexcept { return {}; }
  /// How far beside `lap` [m] the controller is about to drive: what taking it up now makes it correct. 0: to
  /// be taken up at once.
  [[nodiscard]] virtual double beside(const road::RacingRoad& /*lap*/) const noexcept { return 0.0; }
  /// Forget everything learned (map, warm start): a new run begins. A planned lap stays, one of a road that
  /// was learned does not.
  virtual void reset() noexcept = 0;
  [[nodiscard]] virtual std::string_view name() const noexcept = 0;
  /// Names of Explanation's cost terms and of the bits of its active constraints; empty for none.
  [[nodiscard]] virtual std::span<const std::string_view> cost_terms() const noexcept { return {}; }
  [[nodiscard]] virtual std::span<const std::string_view> constraints() const noexcept { return {}; }
};

}  // namespace chicane::controller
