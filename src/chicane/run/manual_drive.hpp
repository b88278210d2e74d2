// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::run {

/// Input of a person at the wheel.
struct ManualSetting {
  enum class What { kIsOn, kSteer, kThrottle } what = What::kIsOn;
  double value = 0.0;  ///< kIsOn: 0 is off; else in [-1, 1]
};

/// A person at the wheel instead of the controller. Everything here happens in the time of the run, so a run
/// with the same changes at the same cycles is the same run. No allocation; one thread.
class ManualDrive {
 public:
  /// Silence of all settings after which the car brakes gently [s].
  static constexpr double kSilenceLimit = 1.0;

  void set(const ManualSetting& setting) noexcept;
  [[nodiscard]] bool is_on() const noexcept { return is_on_; }
  /// The person's command for a measured car. The steering is a share of the lock. Full braking is the
  /// largest useful one; near standstill a negative throttle is passed on unchanged, which reverses cars that
  /// can.
  [[nodiscard]] model::Command command(const model::Measurement& now,
                                       const model::VehicleParams& vehicle) noexcept;
  /// Restarts time for a new run. The person keeps the wheel.
  void restart() noexcept;

 private:
  bool is_on_ = false;
  double steer_ = 0.0;     ///< left positive; [-1, 1]
  double throttle_ = 0.0;  ///< [-1, 1]
  bool has_news_ = false;  ///< something was set since the last command
  double last_set_ = 0.0;  ///< [s]
};

}  // namespace chicane::run
