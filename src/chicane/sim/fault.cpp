// SPDX-License-Identifier: MIT
#include "chicane/sim/fault.hpp"

#include <algorithm>

#include "chicane/base/angle.hpp"

namespace chicane::sim {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t kNoiseStream = 0x6e6f697365;  // "noise"
constexpr std::uint64_t kLossStream = 0x6c6f7373;     // "loss"

constexpr std::array<FaultKind, kFaultCount> kKinds{{
    {"link_lost", "No measurement arrives.", 2.0, 1.0, 1.0, 1.0, ""},
    {"frozen_sensor", "Every measurement is the last one before, with a new time.", 1.0, 1.0, 1.0, 1.0, ""},
    {"nan_measurement", "Position, yaw and speed are not numbers.", 2.0, 1.0, 1.0, 1.0, ""},
    {"position_jump", "The measured position lies to the left of the car.", 1.0, 5.0, -100.0, 100.0,
     "distance, right negative [m]"},
    {"gps_noise", "The measured position is noisy.", 3.0, 0.5, 0.0, 100.0, "standard deviation [m]"},
    {"speed_sensor_zero", "The measured speed is zero.", 1.0, 1.0, 1.0, 1.0, ""},
    {"waypoints_missing", "Telemetry shows no waypoints.", 2.0, 1.0, 1.0, 1.0, ""},
    {"half_grip", "Tyre forces are reduced.", 5.0, 0.5, 0.05, 1.0, "share of the force that is left"},
    {"ice_patch", "A short stretch of ice.", 0.3, 0.1, 0.05, 1.0, "share of the force that is left"},
    {"side_wind", "A gust from the right.", 2.0, 2.0, -10.0, 10.0, "push to the left [m/s²]"},
    {"weak_brakes", "The brakes give less than asked for.", 5.0, 0.3, 0.0, 1.0, "share that is left"},
    {"steering_stuck", "The wheel stays where it is.", 0.5, 1.0, 1.0, 1.0, ""},
    {"steering_offset", "The wheel stands off what is asked for.", 5.0, 2.0, -20.0, 20.0,
     "angle to the left [deg]"},
    {"throttle_stuck", "The pedal stays where it is.", 2.0, 1.0, 1.0, 1.0, ""},
    {"slow_solver", "The deadline of each step is spent almost at once.", 5.0, 1.0, 1.0, 100.0,
     "questions to the clock until then"},
    {"dead_controller", "No command arrives.", 1.0, 1.0, 1.0, 1.0, ""},
    {"delay_doubled", "Commands take longer than the controller knows.", 5.0, 2.0, 1.0, 5.0,
     "times the latency"},
    {"command_dropped", "Some commands never arrive.", 5.0, 0.5, 0.0, 1.0, "share that is lost"},
}};

}  // namespace

std::span<const FaultKind> fault_kinds() noexcept { return kKinds; }

std::optional<Fault> fault_named(std::string_view name) noexcept {
  for (std::size_t i = 0; i < kFaultCount; ++i) {
    if (kKinds[i].name == name) return static_cast<Fault>(i);
  }
  return std::nullopt;
}

FaultEvent default_event(Fault fault, double at) noexcept {
  const FaultKind& kind = kind_of(fault);
  return {fault, at, kind.duration, kind.strength};
}

FaultLab::FaultLab(std::span<const FaultEvent> events, std::uint64_t seed) noexcept
    : event_count_{std::min(events.size(), kCapacity)},
      seed_{seed},
      noise_{seed ^ kNoiseStream},
      loss_{seed ^ kLossStream} {
  std::copy_n(events.begin(), event_count_, events_.begin());
}

void FaultLab::reset() noexcept {
  has_begun_ = {};
  active_ = {};
  bits_ = 0;
  noise_ = Random{seed_ ^ kNoiseStream};
  loss_ = Random{seed_ ^ kLossStream};
  frozen_.reset();
  stuck_steer_.reset();
  stuck_throttle_.reset();
}

void FaultLab::update(double time) noexcept {
  constexpr double kRounding = 1e-9;  // sums of step lengths round
  for (std::size_t i = 0; i < kFaultCount; ++i) {
    const auto fault = static_cast<Fault>(i);
    if (is_on(fault) && time >= active_[i].until - kRounding) end(fault);
  }
  for (std::size_t i = 0; i < event_count_; ++i) {
    const FaultEvent& event = events_[i];
    if (has_begun_[i] || time < event.at - kRounding) continue;
    has_begun_[i] = true;
    begin(event.fault, event.at + event.duration, event.strength);
  }
}

void FaultLab::set(Fault fault, bool on, double time) noexcept {
  if (on == is_on(fault)) return;
  if (!on) return end(fault);
  const FaultKind& kind = kind_of(fault);
  begin(fault, time + kind.duration, kind.strength);
}

void FaultLab::begin(Fault fault, double until, double strength) noexcept {
  active_[static_cast<std::size_t>(fault)] = {until, strength};
  bits_ |= bit(fault);
}

void FaultLab::end(Fault fault) noexcept {
  bits_ &= ~bit(fault);
  if (fault == Fault::kFrozenSensor) frozen_.reset();
  if (fault == Fault::kSteeringStuck) stuck_steer_.reset();
  if (fault == Fault::kThrottleStuck) stuck_throttle_.reset();
}

model::Measurement FaultLab::seen(const model::Measurement& now) noexcept {
  model::Measurement told = now;
  if (is_on(Fault::kFrozenSensor)) {
    if (!frozen_) frozen_ = now;
    told = *frozen_;
    told.time = now.time;
    told.delay = now.delay;
  }
  if (is_on(Fault::kGpsNoise)) {
    told.x += strength(Fault::kGpsNoise) * noise_.normal();
    told.y += strength(Fault::kGpsNoise) * noise_.normal();
  }
  if (is_on(Fault::kPositionJump)) {
    told.x -= strength(Fault::kPositionJump) * sin(now.psi);
    told.y += strength(Fault::kPositionJump) * cos(now.psi);
  }
  if (is_on(Fault::kSpeedSensorZero)) told.speed = 0.0;
  const bool is_lost = is_on(Fault::kLinkLost);
  if (is_lost || is_on(Fault::kWaypointsMissing)) told.waypoint_count = 0;
  if (is_lost || is_on(Fault::kNanMeasurement)) told.x = told.y = told.psi = told.speed = kNothing;
  if (is_lost) told.steer = told.throttle = kNothing;
  return told;
}

bool FaultLab::is_delivered() noexcept {
  if (is_on(Fault::kDeadController)) return false;
  return !is_on(Fault::kCommandDropped) || loss_.uniform() >= strength(Fault::kCommandDropped);
}

model::Command FaultLab::done(const model::Command& command) noexcept {
  model::Command result = command;
  if (is_on(Fault::kSteeringStuck)) {
    if (!stuck_steer_) stuck_steer_ = command.steer;
    result.steer = *stuck_steer_;
  }
  if (is_on(Fault::kSteeringOffset)) result.steer += degrees_to_radians(strength(Fault::kSteeringOffset));
  if (is_on(Fault::kThrottleStuck)) {
    if (!stuck_throttle_) stuck_throttle_ = command.throttle;
    result.throttle = *stuck_throttle_;
  }
  if (is_on(Fault::kWeakBrakes) && result.throttle < 0.0) result.throttle *= strength(Fault::kWeakBrakes);
  return result;
}

double FaultLab::extra_delay(double latency) const noexcept {
  return is_on(Fault::kDelayDoubled) ? (strength(Fault::kDelayDoubled) - 1.0) * latency : 0.0;
}

double FaultLab::grip() const noexcept {
  return (is_on(Fault::kHalfGrip) ? strength(Fault::kHalfGrip) : 1.0) *
         (is_on(Fault::kIcePatch) ? strength(Fault::kIcePatch) : 1.0);
}

double FaultLab::side_acceleration() const noexcept {
  return is_on(Fault::kSideWind) ? strength(Fault::kSideWind) : 0.0;
}

std::uint32_t FaultLab::deadline_questions() const noexcept {
  return is_on(Fault::kSlowSolver) ? static_cast<std::uint32_t>(strength(Fault::kSlowSolver)) : 0;
}

}  // namespace chicane::sim
