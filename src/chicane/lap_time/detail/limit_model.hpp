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

namespace chicane::lap_time {

/// Weights of a feedback's two inputs, squared and second, and times which where the drive has no more to
/// give.
struct Tuning {
  std::array<double, 2> inputs{1.0, 1.0};
  double spent = 1.0;
};

/// A plant, whose plans are also driven.
class LimitModel : public PlanModel {
 public:
  /// Reserves for plans to be driven, in order: the first plan that can be driven is taken.
  [[nodiscard]] virtual std::span<const Reserve> reserves() const = 0;

  /// PlanSearch::Options::slip_caps; empty: the search converges without.
  [[nodiscard]] virtual std::span<const double> slip_caps() const { return {}; }

  /// Feedback along a plan: the first `driven` states, and two inputs from variable `input` on. Weights of
  /// errors and inputs, over each of them squared and second.
  [[nodiscard]] virtual int driven() const = 0;
  [[nodiscard]] virtual int input() const = 0;
  [[nodiscard]] virtual std::vector<double> error_weights() const = 0;
  /// Weights of the feedback to try in turn: plans at the limit differ in how well they are followed.
  [[nodiscard]] virtual std::span<const Tuning> tunings() const = 0;
  /// The drive has no more to give at a plan's variables.
  [[nodiscard]] virtual bool is_spent(const double* z) const = 0;

  /// State inside the plant that no State shows, tracked from commands and measurements.
  virtual void start() = 0;
  virtual void see(const model::Command& asked, const sim::PlantOutput& output, double elapsed) = 0;
  /// The driven states beyond offset and heading.
  virtual void motion(const model::State& state, double* states) const = 0;
  /// Command to send: `z` is the plan's node a moment ahead, `inputs` its two inputs with feedback.
  [[nodiscard]] virtual model::Command command(const model::State& state, const double* z,
                                               const double* inputs) const = 0;
};

/// The model of that plant with that deviation, a double track of those parameters. kNotFound for a plant
/// without one.
[[nodiscard]] Result<std::unique_ptr<LimitModel>> make_limit_model(std::string_view plant,
                                                                   const sim::PlantDeviation& deviation,
                                                                   const sim::DoubleTrackParams& params = {});

}  // namespace chicane::lap_time
