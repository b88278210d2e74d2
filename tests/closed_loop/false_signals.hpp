// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "chicane/base/random.hpp"
#include "chicane/model/state.hpp"
#include "chicane/run/closed_loop.hpp"

/// Wrong telemetry and wrong actuators, for attacks on the guard.
namespace chicane::attack {

/// The measurements of a run so far, and numbers that a false signal keeps.
class SignalMemory {
 public:
  SignalMemory(std::uint64_t seed, double car_size);
  void add(const model::Measurement& now);
  /// The run's first measurement.
  [[nodiscard]] const model::Measurement& first() const { return first_; }
  /// The latest measurement that is not younger than `time` [s]; the oldest remembered one where there is
  /// none.
  [[nodiscard]] const model::Measurement& at(double time) const;
  /// `cycles` before the last one; 0: the last one.
  [[nodiscard]] const model::Measurement& before(std::size_t cycles) const;

  Random random;
  double length;                             ///< of the car over one in full size
  double time;                               ///< its root: times and speeds of a model car
  double began = 0.0;                        ///< the false signal [s]
  std::optional<model::Measurement> kept{};  ///< for the signal's own use; empty when it begins

 private:
  static constexpr std::size_t kRemembered = 512;  ///< cycles: 2 s of a control period of 4 ms
  std::array<model::Measurement, kRemembered> past_{};
  model::Measurement first_;
  std::size_t count_ = 0;
};

/// A way in which signals are wrong.
struct FalseSignal {
  std::string name;
  std::function<void(SignalMemory&, model::Measurement&)> measured{};
  std::function<void(model::Command&)> actuated{};
  double put_on_lap = -1.0;  ///< share of the lap where the car is put when it begins; negative: nowhere
};

/// All of them with their strengths. Lengths and times are of a car in full size.
[[nodiscard]] std::vector<FalseSignal> false_signals();

/// Remembers what is measured in `loop` from now on.
[[nodiscard]] std::shared_ptr<SignalMemory> remember(run::ClosedLoop& loop, std::uint64_t seed);

/// From the next step of `loop` on signals are false, for `duration` [s] of the run.
void make_false(run::ClosedLoop& loop, const FalseSignal& signal, std::shared_ptr<SignalMemory> memory,
                double duration);

}  // namespace chicane::attack
