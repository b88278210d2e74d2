// SPDX-License-Identifier: MIT
// Settings that change during a run: read and checked once, then handed as plain data to the control thread.
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

/// Person at the wheel in place of the controller. All times are the run's: equal changes at equal cycles
/// give equal bits. No allocation; one thread.
class ManualDrive {
 public:
  /// Time without any input after which the car brakes gently [s]; chosen.
  static constexpr double kSilenceLimit = 1.0;

  void set(const ManualSetting& setting) noexcept;
  [[nodiscard]] bool is_on() const noexcept { return is_on_; }
  /// Command of the person for a measured car. Steering is a share of the lock. A negative throttle is a
  /// share of the largest useful braking; near standstill it is passed on unchanged, which engages the
  /// reverse gear of cars that have one.
  [[nodiscard]] model::Command command(const model::Measurement& now,
                                       const model::VehicleParams& vehicle) noexcept;
  /// Restarts the time for another run. The person keeps the wheel.
  void restart() noexcept;

 private:
  bool is_on_ = false;     ///< a person drives
  double steer_ = 0.0;     ///< share of the lock, left positive, [-1, 1]
  double throttle_ = 0.0;  ///< share of full throttle or braking, [-1, 1]
  bool has_news_ = false;  ///< an input has come since the last command
  double last_set_ = 0.0;  ///< run time of the last input [s]
};

/// Range of "run.pace", run seconds per second of the clock; chosen.
inline constexpr double kSlowestPace = 0.05;
inline constexpr double kFastestPace = 20.0;

/// Change of a field of the scenario.
struct FieldValue {
  const protocol::Parameter* row = nullptr;  ///< row of the schema, whose field is no text
  std::variant<double, bool> value;          ///< value of the field: SI; an enum as its number
};
/// Change of the run's pace.
struct Pace {
  double value = 1.0;  ///< [kSlowestPace, kFastestPace]
};
/// Switch of a fault.
struct FaultSwitch {
  enum class To { kOff, kOn, kAsGiven } to = To::kOff;  ///< kOn: with the duration and strength of its kind
  sim::FaultEvent event{};  ///< the fault; its duration and strength count with kAsGiven only
};
/// Terms of a planned lap to race by: grip and road as the controller has learned them (LapPlanner).
using LearnedLap = road::LapTerms;

/// Effect of a setting on a run. std::monostate: none, because the setting needs another run.
using Action = std::variant<std::monostate, FieldValue, Pace, ManualSetting, FaultSwitch, LearnedLap>;

/// One change of a setting, read and checked once. Plain data for handing from thread to thread.
struct Setting {
  telemetry::Change change;  ///< change for recordings and viewers
  Action action;             ///< effect on the run
};
using SettingQueue = ThreadQueue<Setting>;
using ChangeQueue = ThreadQueue<telemetry::Change>;

/// Sets a field of `scenario` to `value` in the key's unit, and returns the setting; without an action if the
/// field is a text. Fails as protocol::set(), without a change of the scenario. Allocates.
[[nodiscard]] Result<Setting> set_field(scenario::Scenario& scenario, const protocol::Parameter& row,
                                        const protocol::Value& value);
/// Reads a change given as text. Its name is a key of the schema whose value is no text, "run.pace",
/// "manual.…" or "fault.…"; in recordings also "run.racing_line". Fails as --set does, with key, value and
/// expectation. Allocates.
[[nodiscard]] Result<Setting> read_setting(const telemetry::Change& change);

/// Sets the field of `scenario`. No allocation.
void write(scenario::Scenario& scenario, const FieldValue& field) noexcept;

}  // namespace chicane::run
