// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

#include "chicane/base/deadline.hpp"
#include "chicane/controller/explanation.hpp"
#include "chicane/controller/plan.hpp"
#include "chicane/model/measurement.hpp"
#include "chicane/model/state.hpp"
#include "chicane/solver/solution.hpp"

namespace chicane::controller {

/// Who chose the command. Kept by controller/fallback.cpp and nowhere else.
enum class Rung : signed char {
  kController = 0,    ///< the controller's own answer
  kShiftedPlan = 1,   ///< the last usable plan, at the time that has come
  kHoldAndBrake = 2,  ///< steering along the last plan's path, gentle braking
  kBrake = 3,         ///< the same steering, all useful braking
};

/// How one step went.
struct StepReport {
  solver::SolveReport solve;  ///< zeroed with status kOptimal for controllers that solve nothing
  Rung rung = Rung::kController;
  double lateral_error = 0.0;    ///< of the measured position from the reference line [m], left positive
  double heading_error = 0.0;    ///< measured yaw minus the line's heading [rad]
  double speed_reference = 0.0;  ///< wanted at the point where the command acts [m/s]
  double delay = 0.0;            ///< compensated: from measurement to actuation [s]
  double sight = 0.0;            ///< length of known road ahead [m]
  double solve_time = 0.0;  ///< of the optimisation alone [s], as the deadline's clock saw it; 0 without one
  bool has_map = false;     ///< the lap is closed in memory
  bool gated = false;       ///< the command gate had to change the command
  Explanation explanation;  ///< why the answer is what it is; empty on a rung below the controller
};

struct StepResult {
  model::Command command;  ///< always finite and inside the vehicle's limits
  Plan plan;
  StepReport report;
};

/// The contract every controller fulfils: a measurement goes in, a command comes out, always.
///
/// step() is noexcept, allocates nothing, takes no lock and reads no clock but the deadline's. It accepts any
/// measurement, also one with NaN or without waypoints. The result stays valid until the next call. One
/// thread.
class Controller {
 public:
  virtual ~Controller() = default;
  [[nodiscard]] virtual const StepResult& step(const model::Measurement& now, Deadline deadline) noexcept = 0;
  /// Somebody else drives: this was sent in the place of the last step's command.
  virtual void note_sent(const model::Command& /*command*/) noexcept {}
  /// Forget everything learned (map, warm start): a new run begins.
  virtual void reset() noexcept = 0;
  [[nodiscard]] virtual std::string_view name() const noexcept = 0;
  /// Names of Explanation's cost terms and of the bits of its active constraints; empty for none.
  [[nodiscard]] virtual std::span<const std::string_view> cost_terms() const noexcept { return {}; }
  [[nodiscard]] virtual std::span<const std::string_view> constraints() const noexcept { return {}; }
};

}  // namespace chicane::controller
