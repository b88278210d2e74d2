// SPDX-License-Identifier: MIT
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

/// Speed hold shared by the baselines: throttle = speed_gain · (speed_reference − v) + what drag costs.
struct SpeedHoldOptions {
  double speed_reference = 13.4;            ///< [m/s]
  double speed_gain = 0.3;                  ///< throttle per m/s
  double lateral_acceleration_limit = 8.0;  ///< slows for curvature by v² |κ| <= limit [m/s²]
};

/// Steer on the cross-track error: δ = −(kp e + ki ∫e dt + kd de/dt).
struct PidOptions {
  double proportional_gain = 0.06;  ///< [rad/m]
  double integral_gain = 0.0;       ///< [rad/(m s)]
  double derivative_gain = 0.06;    ///< [rad s/m]
  SpeedHoldOptions speed;
};

/// Steer along the circle through a point ahead on the path (Coulter 1992).
struct PurePursuitOptions {
  double lookahead_time = 0.8;  ///< [s]
  double lookahead_min = 5.0;   ///< [m]
  SpeedHoldOptions speed;
};

/// Heading error plus arctan of the front axle's cross-track error over speed (Hoffmann et al. 2007).
struct StanleyOptions {
  double gain = 1.5;             ///< [1/s]
  double softening_speed = 2.0;  ///< [m/s]
  SpeedHoldOptions speed;
};

/// Makes a controller. kInvalidArgument names an option outside the range in its row, here and below.
[[nodiscard]] Result<std::unique_ptr<Controller>> make_pid(const PidOptions& options,
                                                           const model::VehicleParams& vehicle);
[[nodiscard]] Result<std::unique_ptr<Controller>> make_pure_pursuit(const PurePursuitOptions& options,
                                                                    const model::VehicleParams& vehicle);
[[nodiscard]] Result<std::unique_ptr<Controller>> make_stanley(const StanleyOptions& options,
                                                               const model::VehicleParams& vehicle);

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

/// Speed hold shared by the baselines: a proportional law on top of what drag costs, towards a reference that
/// slows for the curvature ahead. No allocation.
class SpeedHold {
 public:
  SpeedHold(const SpeedHoldOptions& options, const model::VehicleParams& vehicle) noexcept
      : options_{options}, vehicle_{vehicle} {}
  void configure(const SpeedHoldOptions& options, const model::VehicleParams& vehicle) noexcept {
    options_ = options;
    vehicle_ = vehicle;
  }

  struct Wanted {
    double speed = 0.0;  ///< [m/s]
    SpeedLimiter limiter = SpeedLimiter::kAsked;
  };
  /// Speed wanted at arc length s of `path`: at most the reference, and slow enough to meet v² |κ| <= limit
  /// everywhere ahead with comfortable braking.
  [[nodiscard]] Wanted reference(const road::Path& path, double s) const noexcept;
  /// Pedal in [-brake_throttle_limit, 1] towards `wanted` [m/s] at speed v [m/s].
  [[nodiscard]] double throttle(double wanted, double v) const noexcept;

 private:
  SpeedHoldOptions options_;
  model::VehicleParams vehicle_;
};

}  // namespace chicane::controller
