// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "chicane/controller/prediction.hpp"
#include "chicane/model/measurement.hpp"
#include "chicane/model/state.hpp"

namespace chicane::controller {

/// The commands this controller has sent, with the time from which each acts. Fixed memory; the oldest is
/// forgotten.
class CommandHistory {
 public:
  void clear() noexcept { count_ = 0; }
  /// `command` acts from `time` [s] on; later commands replace earlier ones that would act later.
  void add(double time, const model::Command& command) noexcept;
  /// The command acting at `time`; zero before the first.
  [[nodiscard]] model::Command at(double time) const noexcept;
  /// First change of command after `time`, or `limit` when there is none before it.
  [[nodiscard]] double next_change(double time, double limit) const noexcept;

 private:
  struct Entry {
    double time = 0.0;
    model::Command command;
  };
  static constexpr int kCapacity = 128;
  std::array<Entry, kCapacity> entries_{};  ///< ring, ascending in time
  int first_ = 0;
  int count_ = 0;
  [[nodiscard]] const Entry& entry(int i) const noexcept {
    return entries_[static_cast<std::size_t>((first_ + i) % kCapacity)];
  }
};

/// Where the car is, and where it will be when the next command acts: the prediction model driven by the
/// commands that are really in flight, corrected by each measurement. Yaw rate and sideslip, which telemetry
/// does not hold, come from here.
class StateEstimator {
 public:
  explicit StateEstimator(const PredictionModel& model) noexcept : model_{model} {}
  void reset() noexcept { is_started_ = false; }
  /// Another model from now on; the estimate stays.
  void set_model(const PredictionModel& model) noexcept { model_ = model; }

  /// Takes in a measurement. Afterwards state() is the estimate at now.time; one that is not finite is
  /// replaced by what the model expects.
  void correct(const model::Measurement& now, const CommandHistory& sent) noexcept;
  [[nodiscard]] const model::State& state() const noexcept { return state_; }
  [[nodiscard]] bool is_started() const noexcept { return is_started_; }
  [[nodiscard]] double acceleration() const noexcept { return acceleration_; }

  /// The state at `time` >= the last measurement's [s], commands in flight replayed for exactly the fractions
  /// they act.
  struct Prediction {
    model::State state;
    double acceleration = 0.0;  ///< net longitudinal acceleration then [m/s²]
  };
  [[nodiscard]] Prediction predict(double time, const CommandHistory& sent) const noexcept;

 private:
  void advance(model::State& state, double& acceleration, double from, double to,
               const CommandHistory& sent) const noexcept;

  PredictionModel model_;
  bool is_started_ = false;
  double time_ = 0.0;
  model::State state_;
  double acceleration_ = 0.0;
};

}  // namespace chicane::controller
