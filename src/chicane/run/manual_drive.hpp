// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/model/measurement.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/telemetry/change.hpp"

namespace chicane::run {

/// A person at the wheel instead of the controller. Everything here happens in the time of the run, so a run
/// with the same changes at the same cycles is the same run. No allocation; one thread.
class ManualDrive {
 public:
  /// Without a word from the person for so long the car brakes gently [s].
  static constexpr double kPatience = 1.0;

  /// "manual.is_on", "manual.steer" or "manual.throttle"; false, and nothing happens, for anything else.
  bool apply(const telemetry::Change& change) noexcept;
  [[nodiscard]] bool is_on() const noexcept { return is_on_; }
  /// What the person wants of a car that is measured so. The steering is a share of the lock. Full braking is
  /// all that is useful; near standstill a negative throttle is passed on as it is, which reverses cars that
  /// can.
  [[nodiscard]] model::Command wish(const model::Measurement& now,
                                    const model::VehicleParams& vehicle) noexcept;
  /// A new run: time begins anew. The person keeps the wheel.
  void restart() noexcept;

 private:
  bool is_on_ = false;
  double steer_ = 0.0;       ///< left positive; [-1, 1]
  double throttle_ = 0.0;    ///< [-1, 1]
  bool has_spoken_ = false;  ///< since the last wish
  double last_word_ = 0.0;   ///< [s]
};

}  // namespace chicane::run
