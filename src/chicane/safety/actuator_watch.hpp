// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "chicane/base/vec2.hpp"
#include "chicane/model/prediction.hpp"
#include "chicane/model/state.hpp"
#include "chicane/tracking/state_estimator.hpp"

namespace chicane::safety {

/// Deviation of the actuators from their configuration: the wheels turn to gain · command + offset, the
/// brakes decelerate by a share, and both act later.
struct ActuatorAnswer {
  double gain = 1.0;
  double offset = 0.0;   ///< [rad]
  double braking = 1.0;  ///< deceleration over the configured one, (0, 1]
  double delay = 0.0;    ///< delay beyond the configured one [s]

  /// Whether the actuators answer as configured.
  [[nodiscard]] bool is_usual() const noexcept { return *this == ActuatorAnswer{}; }
  [[nodiscard]] bool operator==(const ActuatorAnswer&) const = default;
  /// Command that turns the wheels to the angle of `wanted`.
  [[nodiscard]] model::Command command_for(const model::Command& wanted) const noexcept {
    return {(wanted.steer - offset) / gain, wanted.throttle};
  }
  /// Angle of the wheels, and pedal, that `command` leads to.
  [[nodiscard]] model::Command effect_of(const model::Command& command) const noexcept {
    return {gain * command.steer + offset, command.throttle};
  }
  /// Both deviations in a row: `first`, then this one.
  [[nodiscard]] ActuatorAnswer after(const ActuatorAnswer& first) const noexcept {
    return {.gain = gain * first.gain,
            .offset = gain * first.offset + offset,
            .braking = braking * first.braking,
            .delay = delay + first.delay};
  }
};

/// The same car with an empty name: copies of it do not allocate.
[[nodiscard]] model::VehicleParams without_name(model::VehicleParams vehicle) noexcept;

/// Finds wheels and brakes that stop answering as configured, by comparing the measured motion with the
/// commands (docs/guard.md, "The actuators", eq. 12 and 13). Offset and braking are estimated from when the
/// difference exceeds its band until they have been usual for kUsualFor. Judges only a car that drives
/// forward, faster than kSlowest, with grip to spare. No allocation; one thread.
class ActuatorWatch {
 public:
  // The band of eq. 12 is the sum of the first three; docs/guard.md says why each is there.
  static constexpr double kBand = 0.01;      ///< [rad] constant part
  static constexpr double kBandShare = 0.1;  ///< part that grows with the angle
  static constexpr double kSlipShare = 0.2;  ///< part that grows with the slip of the axle that slips more
  static constexpr double kSlipShareUsed = 0.5;  ///< in place of kSlipShare near the limit of grip
  static constexpr double kWeak = 0.75;          ///< braking of eq. 13 below which brakes are weak
  static constexpr double kUsualFor = 1.0;       ///< [s] usual answers that end an estimate
  /// [m/s] Slowest judged speed of a full-size car. A slower car may be led back (guard_way_back.cpp).
  static constexpr double kSlowest = 6.0;

  explicit ActuatorWatch(const model::VehicleParams& vehicle) noexcept;
  void reset() noexcept;
  /// Changes the car; `vehicle` describes it with usual actuators.
  void set_vehicle(const model::VehicleParams& vehicle) noexcept;

  /// Estimated slip of each axle's tyres over their peak slip.
  struct AxleUse {
    double front = 0.0;
    double rear = 0.0;
    std::optional<double> sideslip{};  ///< estimated sideslip of the car [rad]
  };
  /// Updates the estimates with a plausible measurement; `sent`: commands to the actuators. Steering is not
  /// judged while the rear axle slides, brakes while either axle does.
  void see(const model::Measurement& now, const tracking::CommandHistory& sent, const AxleUse& use) noexcept;
  /// Starts again with the next measurement, because this cycle has no plausible one.
  void skip() noexcept { count_ = 0; }

  [[nodiscard]] const ActuatorAnswer& answer() const noexcept { return answer_; }
  /// Car with usual actuators, without its name.
  [[nodiscard]] const model::VehicleParams& usual_vehicle() const noexcept { return model_.vehicle(); }
  /// Car with its brakes as estimated.
  [[nodiscard]] model::VehicleParams vehicle() const noexcept {
    model::VehicleParams car = model_.vehicle();
    car.brake_acceleration *= answer_.braking;
    return car;
  }
  [[nodiscard]] bool has_other_steering() const noexcept { return is_steered_; }
  [[nodiscard]] bool has_weak_brakes() const noexcept { return answer_.braking < 1.0; }

 private:
  /// Measurement, with sums over all commands up to it.
  struct Sample {
    double time = 0.0;     ///< [s]
    double turned = 0.0;   ///< heading, unwrapped [rad]
    double angle = 0.0;    ///< integral of the commanded angle, behind the steering's lag [rad s]
    double swung = 0.0;    ///< sum of the absolute changes of that angle [rad]
    double braking = 0.0;  ///< integral of the braking that the model expects of the pedal [m/s]
    double speed = 0.0;    ///< [m/s]
    double pedal = 0.0;    ///< mean pedal since the sample before
    Vec2 place{};          ///< [m]
  };
  static constexpr std::size_t kSamples = 64;

  /// The sample `count` before the newest one.
  [[nodiscard]] const Sample& back(std::size_t count) const noexcept {
    return samples_[(count_ - 1 - count) % kSamples];
  }
  [[nodiscard]] std::size_t samples_back_to(double time) const noexcept;
  void add_sample(const model::Measurement& now, const tracking::CommandHistory& sent) noexcept;
  /// Mean wheel angles over a window of time (eq. 12), and how sure they are.
  struct Window {
    /// Commanded angle δ_c, and angle δ with which the model turns as the car did [rad].
    double asked = 0.0, angle = 0.0;
    double slip = 0.0;         ///< slip angle of the front tyres, a part of δ [rad]
    double rear_slip = 0.0;    ///< slip angle of the rear tyres [rad]
    double use = 0.0;          ///< slip of the tyres over their peak slip
    double slide = 0.0;        ///< lateral velocity that the model gives a car turning as measured [m/s]
    double changed = 0.0;      ///< uncertainty of δ_c: its change, or late commands [rad]
    double difference = 0.0;   ///< δ − δ_c − offset [rad]
    double noise = 0.0;        ///< mean square change of the difference between measurements, halved [rad²]
    double learned = 0.0;      ///< time over which the noise is averaged [s]
    double calm_for = 0.0;     ///< time without a slide [s]
    double differs_for = 0.0;  ///< time for which the difference has exceeded its band [s]
  };
  [[nodiscard]] bool slides(const Sample& from, double sideslip) const noexcept;
  [[nodiscard]] bool measure(Window& window, double length, double elapsed) const noexcept;
  void judge_steering(Window& window, double length, double elapsed) noexcept;
  void fit_steering(const Window& window, double length, double elapsed) noexcept;
  void judge_braking(double elapsed) noexcept;

  model::PredictionModel model_;
  double pace_;  ///< times and speeds over a full-size car's: √(length / 4.5 m), at most 1
  ActuatorAnswer answer_;
  std::array<Sample, kSamples> samples_{};
  AxleUse use_;
  std::size_t count_ = 0;
  double angle_ = 0.0;               ///< angle of wheels that answer as usual [rad]
  double last_psi_ = 0.0;            ///< heading of the last measurement [rad]
  std::array<Window, 2> windows_{};  ///< a short one, and a long one for noisy sensors
  double usual_for_ = 0.0;           ///< time for which the estimated offset has been usual [s]
  bool follows_ = true;              ///< the gain is near 1
  bool is_steered_ = false;          ///< the offset is being estimated
  // Normal equations of least squares: [gg go; go oo] (gain − 1, offset) = (g, o), and their memory [s].
  double gg_ = 0.0, go_ = 0.0, oo_ = 0.0, g_ = 0.0, o_ = 0.0, memory_ = 0.0;
  double weak_for_ = 0.0;     ///< time for which the brakes have been weak [s]
  double share_ = 1.0;        ///< deceleration over the expected one, smoothed
  double speed_noise_ = 0.0;  ///< mean square of the measured speed's noise [m²/s²]
};

}  // namespace chicane::safety
