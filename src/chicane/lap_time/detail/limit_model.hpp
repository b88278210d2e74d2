// SPDX-License-Identifier: MIT
// Interface of a simulated car whose fastest lap is searched, and then driven with feedback to prove that it
// can be driven.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/lap_time/detail/plan_model.hpp"
#include "chicane/model/state.hpp"
#include "chicane/sim/double_track.hpp"
#include "chicane/sim/plant.hpp"

namespace chicane::lap_time {

/// Weights of the two inputs in the cost of the linear-quadratic feedback, the integral over time of
/// … + inputs[0] · steering² + inputs[1] · pedal².
struct Tuning {
  std::array<double, 2> inputs{1.0, 1.0};
  double saturated_pedal_factor = 1.0;  ///< factor of the pedal's weight where is_drive_saturated()
};

/// Plant whose fastest lap is searched and driven.
class LimitModel : public PlanModel {
 public:
  /// Reserves of the plans to drive, in order: the first plan that can be driven is the Witness (limit.hpp).
  [[nodiscard]] virtual std::span<const Reserve> reserves() const = 0;

  /// Limits of the tyres' slip, as shares of the slip at peak force, for the rounds of a search one after the
  /// other (PlanSearch::Options::slip_caps); empty: the search converges without them.
  [[nodiscard]] virtual std::span<const double> slip_caps() const { return {}; }

  /// Number of states that the feedback uses; they are the first ones of the plan's variables.
  [[nodiscard]] virtual int feedback_states() const = 0;
  /// Index of the first of the two variables that are inputs of the feedback.
  [[nodiscard]] virtual int first_input() const = 0;
  /// Weights of these states' squared errors in the same cost (Tuning).
  [[nodiscard]] virtual std::vector<double> error_weights() const = 0;
  /// Tunings of the feedback to try in turn: plans at the limit differ in how well they are followed.
  [[nodiscard]] virtual std::span<const Tuning> tunings() const = 0;
  /// Whether the drive has no reserve at a plan's variables.
  [[nodiscard]] virtual bool is_drive_saturated(const double* z) const = 0;

  /// Starts the estimate of plant states that State does not contain, such as lags.
  virtual void start_estimate() = 0;
  /// Updates the estimate of start_estimate(), `elapsed` [s] after the last call.
  virtual void update_estimate(const model::Command& asked, const sim::PlantOutput& seen, double elapsed) = 0;
  /// Writes the feedback's states to `states`, except for offset and heading, which the caller writes.
  virtual void read_states(const model::State& state, double* states) const = 0;
  /// Command for the plant. `z`: the plan's variables half a step ahead, where the command acts. `inputs`:
  /// the two inputs of the plan there, plus feedback.
  [[nodiscard]] virtual model::Command command(const model::State& state, const double* z,
                                               const double* inputs) const = 0;
};

/// Makes the limit model of a plant; `params`: parameters of the plant `double-track`. Fails with kNotFound
/// for a plant without one.
[[nodiscard]] Result<std::unique_ptr<LimitModel>> make_limit_model(std::string_view plant,
                                                                   const sim::PlantDeviation& deviation,
                                                                   const sim::DoubleTrackParams& params = {});

}  // namespace chicane::lap_time
