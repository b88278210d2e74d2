// SPDX-License-Identifier: MIT
#pragma once

#include <variant>

#include "chicane/base/result.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/road/reference_line.hpp"
#include "chicane/run/parallel.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/sim/fault.hpp"
#include "chicane/telemetry/metrics.hpp"

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

/// Run seconds per second of the clock: the range of "run.pace".
inline constexpr double kSlowestPace = 0.05;
inline constexpr double kFastestPace = 20.0;

/// A field of the scenario gets another value.
struct FieldValue {
  const protocol::Parameter* row = nullptr;  ///< row of the schema; its field is no text
  std::variant<double, bool> value;          ///< value as the field has it: SI, an enum as its number
};
/// The run goes at another pace.
struct Pace {
  double value = 1.0;  ///< [kSlowestPace, kFastestPace]
};
/// A fault is switched.
struct FaultSwitch {
  enum class To { kOff, kOn, kAsGiven } to = To::kOff;  ///< kOn: with the kind's own duration and strength
  sim::FaultEvent event{};  ///< fault; kAsGiven: with this duration and strength, from now on
};
/// The lap to race by that is planned for road and grip as the controller has learned them (LapPlanner).
using LearnedLap = road::LapTerms;

/// Effect of a setting on a running run. std::monostate: none, because the run restarts with it.
using Action = std::variant<std::monostate, FieldValue, Pace, ManualSetting, FaultSwitch, LearnedLap>;

/// One change of a setting, made and checked once: data that is handed from thread to thread and applied.
/// Plain; no allocation.
struct Setting {
  telemetry::Change change;  ///< change for recordings and viewers
  Action action;
};
using SettingQueue = ThreadQueue<Setting>;
using ChangeQueue = ThreadQueue<telemetry::Change>;

/// Sets a field of `scenario` to `value` in the key's unit, and gives the change; its action is none where
/// the field is a text. Fails as protocol::set() does; the scenario is not changed then. Allocates.
[[nodiscard]] Result<Setting> set_field(scenario::Scenario& scenario, const protocol::Parameter& row,
                                        const protocol::Value& value);
/// Reads a change that is text: a key of the schema whose value is no text, "run.pace", "manual.…" or
/// "fault.…"; of a recording "run.racing_line", too. Fails as --set does, with the key, the value and the
/// expectation. Allocates.
[[nodiscard]] Result<Setting> read_setting(const telemetry::Change& change);

/// Sets the field. No allocation.
void write(scenario::Scenario& scenario, const FieldValue& field) noexcept;

}  // namespace chicane::run
