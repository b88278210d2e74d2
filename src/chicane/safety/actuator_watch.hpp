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

/// How the actuators answer: the wheels turn to gain · command + offset, the brakes give a share of what is
/// asked for, and both act later than configured.
struct ActuatorAnswer {
  double gain = 1.0;
  double offset = 0.0;   ///< [rad]
  double braking = 1.0;  ///< (0, 1]
  double delay = 0.0;    ///< beyond the configured one [s]

  /// Commands have the effect that they are meant to have.
  [[nodiscard]] bool is_usual() const noexcept { return *this == ActuatorAnswer{}; }
  [[nodiscard]] bool operator==(const ActuatorAnswer&) const = default;
  /// The command that turns the wheels as `wanted` says.
  [[nodiscard]] model::Command command_for(const model::Command& wanted) const noexcept {
    return {(wanted.steer - offset) / gain, wanted.throttle};
  }
  /// How the wheels turn by `command`.
  [[nodiscard]] model::Command effect_of(const model::Command& command) const noexcept {
    return {gain * command.steer + offset, command.throttle};
  }
  /// This answer to commands that come out of `first`.
  [[nodiscard]] ActuatorAnswer after(const ActuatorAnswer& first) const noexcept {
    return {.gain = gain * first.gain,
            .offset = gain * first.offset + offset,
            .braking = braking * first.braking,
            .delay = delay + first.delay};
  }
};

/// A car without a name, of which copies do not allocate.
[[nodiscard]] model::VehicleParams without_name(model::VehicleParams vehicle) noexcept;

/// Compares how the car turns and brakes with what was sent to it, by its model (docs/guard.md,
/// eq. 12 and 13). The answer is the usual one until the difference exceeds its band; then offset and braking
/// are estimated, until they have been usual for kUsualFor. It judges a car that moves forward, faster than
/// kSlowest, with grip to spare. No allocation; one thread.
class ActuatorWatch {
 public:
  // Origins (chosen: by trial, see Guard):
  // - Chosen, docs/guard.md: kBand, kBandShare, kSlipShare, kSlipShareUsed (eq. 12), kWeak, kUsualFor (eq.
  //   13).
  // - Derived: kSlowest (Guard's kLedBackSpeed: a slower car may be led).
  static constexpr double kBand = 0.01;          ///< [rad] by which an angle may differ
  static constexpr double kBandShare = 0.1;      ///< and of the angle
  static constexpr double kSlipShare = 0.2;      ///< share of the slip of the axle that slips more
  static constexpr double kSlipShareUsed = 0.5;  ///< the same of tyres that are used, whose grip may be less
  static constexpr double kWeak = 0.75;          ///< share of the braking, below which brakes are weak
  static constexpr double kUsualFor = 1.0;       ///< [s]
  static constexpr double kSlowest = 6.0;        ///< [m/s] of a car in full size

  explicit ActuatorWatch(const model::VehicleParams& vehicle) noexcept;
  void reset() noexcept;
  /// Another car from now on, as it is with usual actuators.
  void set_vehicle(const model::VehicleParams& vehicle) noexcept;

  /// Of the tyres of an axle, as estimated: 1 at their peak slip.
  struct AxleUse {
    double front = 0.0;
    double rear = 0.0;
    std::optional<double> sideslip{};  ///< of the car [rad], as estimated
  };
  /// A measurement that is not in doubt; `sent`: the commands to the actuators. While the rear axle slides
  /// the steering is not judged, and while either does the brakes are not.
  void see(const model::Measurement& now, const tracking::CommandHistory& sent, const AxleUse& use) noexcept;
  /// No measurement is usable.
  void skip() noexcept { count_ = 0; }

  [[nodiscard]] const ActuatorAnswer& answer() const noexcept { return answer_; }
  /// The car with usual actuators, without its name.
  [[nodiscard]] const model::VehicleParams& usual_vehicle() const noexcept { return model_.vehicle(); }
  /// The car with the brakes that it has.
  [[nodiscard]] model::VehicleParams vehicle() const noexcept {
    model::VehicleParams car = model_.vehicle();
    car.brake_acceleration *= answer_.braking;
    return car;
  }
  [[nodiscard]] bool has_other_steering() const noexcept { return is_steered_; }
  [[nodiscard]] bool has_weak_brakes() const noexcept { return answer_.braking < 1.0; }

 private:
  /// Sums up to a measurement.
  struct Sample {
    double time = 0.0;
    double turned = 0.0;   ///< heading, unwrapped [rad]
    double angle = 0.0;    ///< integral of the angle asked for, behind the lag [rad s]
    double swung = 0.0;    ///< all changes of that angle, without their signs [rad]
    double braking = 0.0;  ///< integral of the pedal's deceleration by the model [m/s]
    double speed = 0.0;    ///< [m/s]
    double pedal = 0.0;    ///< mean since the one before
    Vec2 place{};          ///< [m]
  };
  static constexpr std::size_t kSamples = 64;

  [[nodiscard]] const Sample& back(std::size_t count) const noexcept {
    return samples_[(count_ - 1 - count) % kSamples];
  }
  [[nodiscard]] std::size_t samples_back_to(double time) const noexcept;
  void add_sample(const model::Measurement& now, const tracking::CommandHistory& sent) noexcept;
  /// The angles of one window: what was asked for, and what turns the car as it turned.
  struct Window {
    double asked = 0.0, angle = 0.0;  ///< [rad]
    double slip = 0.0;                ///< what of the angle is the front tyres' slip [rad]
    double rear_slip = 0.0;           ///< whose moment is what the front tyres' force comes from [rad]
    double use = 0.0;                 ///< of the tyres' peak slip
    double slide = 0.0;               ///< lateral velocity of the car that turns as measured [m/s]
    double changed = 0.0;             ///< what the angle asked for has changed, or is unsure by [rad]
    double difference = 0.0;          ///< of the angles from the expected answer [rad]
    double noise = 0.0;               ///< mean square of what of it is not there the next time [rad²]
    double learned = 0.0;             ///< time of which the noise is the mean [s]
    double calm_for = 0.0;            ///< time without a slide [s]
    double differs_for = 0.0;         ///< [s]
  };
  [[nodiscard]] bool slides(const Sample& from, double sideslip) const noexcept;
  [[nodiscard]] bool measure(Window& window, double length, double elapsed) const noexcept;
  void judge_steering(Window& window, double length, double elapsed) noexcept;
  void fit_steering(const Window& window, double length, double elapsed) noexcept;
  void judge_braking(double elapsed) noexcept;

  model::PredictionModel model_;
  double pace_;  ///< of time, over that of a car in full size
  ActuatorAnswer answer_;
  std::array<Sample, kSamples> samples_{};
  AxleUse use_;
  std::size_t count_ = 0;
  double angle_ = 0.0;               ///< of the wheels if they answered as usual [rad]
  double last_psi_ = 0.0;            ///< [rad]
  std::array<Window, 2> windows_{};  ///< a short one, and a long one for noisy sensors
  double usual_for_ = 0.0;           ///< [s]
  bool follows_ = true;              ///< the wheels turn as much as they are asked to
  bool is_steered_ = false;          ///< the offset is estimated
  // Normal equations of (gain - 1, offset), and the time that they remember [s].
  double gg_ = 0.0, go_ = 0.0, oo_ = 0.0, g_ = 0.0, o_ = 0.0, memory_ = 0.0;
  double weak_for_ = 0.0;     ///< [s]
  double share_ = 1.0;        ///< of the braking, lately
  double speed_noise_ = 0.0;  ///< mean square of the measured speed's noise [m²/s²]
};

}  // namespace chicane::safety
