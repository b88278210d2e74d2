// SPDX-License-Identifier: MIT
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

/// Interface of a plant whose limit is searched: a car for the search, and the feedback and commands by which
/// the plant drives the plans that are found.

namespace chicane::lap_time {

/// Weights of a feedback's two inputs (steering, pedal), for each second of their squares.
struct Tuning {
  std::array<double, 2> inputs{1.0, 1.0};
  double spent = 1.0;  ///< factor of the pedal's weight where the drive has no reserve (is_spent())
};

/// Plant whose fastest lap is searched and driven.
class LimitModel : public PlanModel {
 public:
  /// Reserves of the plans to drive, in order: the first plan that can be driven is the witness.
  [[nodiscard]] virtual std::span<const Reserve> reserves() const = 0;

  /// PlanSearch::Options::slip_caps; empty: the search converges without them.
  [[nodiscard]] virtual std::span<const double> slip_caps() const { return {}; }

  /// Number of states that the feedback uses: the first ones.
  [[nodiscard]] virtual int driven() const = 0;
  /// Index of the first of the two variables that are inputs of the feedback.
  [[nodiscard]] virtual int input() const = 0;
  /// Weights of the errors of the driven states, for each second of their squares.
  [[nodiscard]] virtual std::vector<double> error_weights() const = 0;
  /// Tunings of the feedback to try in turn: plans at the limit differ in how well they are followed.
  [[nodiscard]] virtual std::span<const Tuning> tunings() const = 0;
  /// Whether the drive has no reserve at a plan's variables.
  [[nodiscard]] virtual bool is_spent(const double* z) const = 0;

  /// Starts the estimate of plant states that State does not contain, such as lags.
  virtual void start() = 0;
  /// Updates that estimate, `elapsed` [s] after the last call.
  virtual void see(const model::Command& asked, const sim::PlantOutput& output, double elapsed) = 0;
  /// Sets the driven states beyond offset and heading.
  virtual void motion(const model::State& state, double* states) const = 0;
  /// Command for the plant: `z` holds the plan's variables a moment ahead, `inputs` its inputs with feedback.
  [[nodiscard]] virtual model::Command command(const model::State& state, const double* z,
                                               const double* inputs) const = 0;
};

/// Makes the limit model of a plant; `params`: parameters of the plant `double-track`. Fails with kNotFound
/// for a plant without one.
[[nodiscard]] Result<std::unique_ptr<LimitModel>> make_limit_model(std::string_view plant,
                                                                   const sim::PlantDeviation& deviation,
                                                                   const sim::DoubleTrackParams& params = {});

}  // namespace chicane::lap_time
