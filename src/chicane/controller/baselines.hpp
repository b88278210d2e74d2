// SPDX-License-Identifier: MIT
// Baselines to compare MPC with: PID, pure pursuit and Stanley steering, with a common speed hold.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "chicane/base/option.hpp"
#include "chicane/base/result.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/path.hpp"

namespace chicane::controller {

/// Options of SpeedHold.
struct SpeedHoldOptions {
  double speed_reference = 13.4;            ///< [m/s]
  double speed_gain = 0.3;                  ///< throttle per speed error [s/m]
  double lateral_acceleration_limit = 8.0;  ///< limit of v² |κ| for the speed in bends [m/s²]
};

/// PID steering on the cross-track error: δ = −(kp e + ki ∫e dt + kd de/dt).
struct PidOptions {
  double proportional_gain = 0.06;  ///< [rad/m]
  double integral_gain = 0.0;       ///< [rad/(m s)]
  double derivative_gain = 0.06;    ///< [rad s/m]
  SpeedHoldOptions speed;
};

/// Pure pursuit: steering along the circle through a point ahead on the path (Coulter 1992).
struct PurePursuitOptions {
  double lookahead_time = 0.8;  ///< distance of the point over speed [s]
  double lookahead_min = 5.0;   ///< least distance of the point [m]
  SpeedHoldOptions speed;
};

/// Stanley steering: δ = −eψ − arctan(gain e / (softening_speed + v)), e: cross-track error of the front axle
/// (Hoffmann et al. 2007).
struct StanleyOptions {
  double gain = 1.5;             ///< [1/s]
  double softening_speed = 2.0;  ///< keeps the gain finite near standstill [m/s]
  SpeedHoldOptions speed;
};

/// Make the controllers. kInvalidArgument names an option outside the range in its row.
[[nodiscard]] Result<std::unique_ptr<Controller>> make_pid(const PidOptions& options,
                                                           const model::VehicleParams& vehicle);
[[nodiscard]] Result<std::unique_ptr<Controller>> make_pure_pursuit(const PurePursuitOptions& options,
                                                                    const model::VehicleParams& vehicle);
[[nodiscard]] Result<std::unique_ptr<Controller>> make_stanley(const StanleyOptions& options,
                                                               const model::VehicleParams& vehicle);

/// Entries of the controllers (controller_list.hpp).
struct PidEntry {
  using Options = PidOptions;
  static constexpr std::string_view kName = "pid";
  static constexpr std::string_view kMeaning = "steering on the cross-track error";
  static constexpr std::string_view kSpeedOption = "speed_reference";
  [[nodiscard]] static std::span<const Option> options() noexcept;
  static constexpr auto kMake = &make_pid;
};

struct PurePursuitEntry {
  using Options = PurePursuitOptions;
  static constexpr std::string_view kName = "pure-pursuit";
  static constexpr std::string_view kMeaning = "steering along the circle through a point ahead";
  static constexpr std::string_view kSpeedOption = "speed_reference";
  [[nodiscard]] static std::span<const Option> options() noexcept;
  static constexpr auto kMake = &make_pure_pursuit;
};

struct StanleyEntry {
  using Options = StanleyOptions;
  static constexpr std::string_view kName = "stanley";
  static constexpr std::string_view kMeaning = "steering by heading error and front-axle cross-track error";
  static constexpr std::string_view kSpeedOption = "speed_reference";
  [[nodiscard]] static std::span<const Option> options() noexcept;
  static constexpr auto kMake = &make_stanley;
};

/// Speed hold of the baselines: throttle = speed_gain · (wanted − v) + the throttle that balances drag. The
/// wanted speed is the reference, lower before bends. No allocation.
class SpeedHold {
 public:
  SpeedHold(const SpeedHoldOptions& options, const model::VehicleParams& vehicle) noexcept
      : options_{options}, vehicle_{vehicle} {}
  void configure(const SpeedHoldOptions& options, const model::VehicleParams& vehicle) noexcept {
    options_ = options;
    vehicle_ = vehicle;
  }

  /// Wanted speed, and its limiter.
  struct Wanted {
    double speed = 0.0;  ///< [m/s]
    SpeedLimiter limiter = SpeedLimiter::kAsked;
  };
  /// Wanted speed at arc length `s` of `path` [m]: at most the reference, and low enough to meet v² |κ| <=
  /// limit everywhere ahead with comfortable braking.
  [[nodiscard]] Wanted reference(const road::Path& path, double s) const noexcept;
  /// Pedal in [-brake_throttle_limit, 1] at speed `v` [m/s] for the speed `wanted` [m/s].
  [[nodiscard]] double throttle(double wanted, double v) const noexcept;

 private:
  SpeedHoldOptions options_;
  model::VehicleParams vehicle_;
};

}  // namespace chicane::controller
