// SPDX-License-Identifier: MIT
// Settings of a run: read from text, written to a scenario; and the commands of a person at the wheel.
#include "chicane/run/setting.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "chicane/base/text.hpp"
#include "chicane/protocol/schema_json.hpp"
#include "chicane/run/racing.hpp"

namespace chicane::run {
namespace {

using protocol::Parameter;

Result<Action> read_fault_switch(std::string_view key, std::string_view value) {
  const std::string_view name = key.substr(key.find('.') + 1);
  const Result<sim::FaultEvent> event = protocol::read_switch(name, value == "false" ? "true" : value);
  if (!event) return fail(event.error());
  const auto to = value == "false"  ? FaultSwitch::To::kOff
                  : value == "true" ? FaultSwitch::To::kOn
                                    : FaultSwitch::To::kAsGiven;
  return FaultSwitch{.to = to, .event = *event};
}

Result<Action> read_manual(std::string_view key, std::string_view value) {
  using What = ManualSetting::What;
  if (key == "manual.is_on") {
    if (value == "true" || value == "false")
      return ManualSetting{.what = What::kIsOn, .value = value == "true" ? 1.0 : 0.0};
    return fail(refusal(key, value, "true or false"));
  }
  if (key != "manual.steer" && key != "manual.throttle")
    return fail(refusal(key, value, "manual.is_on, manual.steer or manual.throttle"));
  const Result<double> share = number_in(key, value, -1.0, 1.0);
  if (!share) return fail(share.error());
  return ManualSetting{.what = key == "manual.steer" ? What::kSteer : What::kThrottle, .value = *share};
}

Result<Action> read_field(std::string_view key, std::string_view text) {
  const Parameter* row = protocol::find(key);
  if (row == nullptr) return fail(ErrorCode::kNotFound, printable(key) + ": " + protocol::unknown_key(key));
  const Result<protocol::Value> value = protocol::parse(*row, text);
  if (!value) return fail(value.error());
  scenario::Scenario scratch;
  const Result<Setting> setting = set_field(scratch, *row, *value);
  if (!setting) return fail(setting.error());
  if (!std::holds_alternative<std::monostate>(setting->action)) return setting->action;
  return fail(ErrorCode::kInvalidArgument, std::string(key) + ": is fixed when a run starts");
}

/// Reads the value of LapPlanner::lap_change(): "0.97, slip 0.8, slides".
Result<Action> read_learned_lap(std::string_view key, std::string_view value) {
  const bool slides = value.ends_with(LapPlanner::kSlides);
  if (slides) value.remove_suffix(LapPlanner::kSlides.size());
  const std::size_t comma = value.find(LapPlanner::kSlip);
  const Result<double> slip =
      comma == value.npos ? 1.0 : number_in(key, value.substr(comma + LapPlanner::kSlip.size()), 0.01, 1.0);
  if (!slip) return fail(slip.error());
  const Result<double> grip = number_in(key, value.substr(0, comma), 0.01, 2.0);
  if (!grip) return fail(grip.error());
  return LearnedLap{*grip, slides, *slip};
}

Result<Action> read_action(std::string_view key, std::string_view value) {
  if (key.starts_with("fault.")) return read_fault_switch(key, value);
  if (key.starts_with("manual.")) return read_manual(key, value);
  if (key == LapPlanner::kChange) return read_learned_lap(key, value);
  if (key != "run.pace") return read_field(key, value);
  const Result<double> pace = number_in(key, value, kSlowestPace, kFastestPace);
  if (!pace) return fail(pace.error());
  return Pace{*pace};
}

}  // namespace

static_assert(std::is_trivially_copyable_v<Setting>);

Result<Setting> set_field(scenario::Scenario& scenario, const Parameter& row, const protocol::Value& value) {
  if (const Result<void> set = protocol::set(scenario, row, value); !set) return fail(set.error());
  Setting setting{.change = {.name = row.key, .value = protocol::text_of(value)}, .action = {}};
  const OptionValue field = row.option.read(row.owner(scenario));
  if (const auto* number = std::get_if<double>(&field)) setting.action = FieldValue{&row, *number};
  if (const auto* flag = std::get_if<bool>(&field)) setting.action = FieldValue{&row, *flag};
  return setting;
}

Result<Setting> read_setting(const telemetry::Change& change) {
  Result<Action> action = read_action(change.name.view(), change.value.view());
  if (!action) return fail(action.error());
  return Setting{.change = change, .action = *action};
}

void write(scenario::Scenario& scenario, const FieldValue& field) noexcept {
  const OptionValue value = std::visit([](auto each) { return OptionValue(each); }, field.value);
  field.row->option.write(field.row->owner(scenario), value);
}

namespace {

constexpr double kGentleBraking = 0.4;  // share of the useful braking after a silence; chosen, as in Fallback
// Speed below which that braking fades, and a negative throttle reverses; chosen [m/s].
constexpr double kFadeSpeed = 2.5;

}  // namespace

void ManualDrive::set(const ManualSetting& setting) noexcept {
  switch (setting.what) {
    case ManualSetting::What::kIsOn:
      is_on_ = setting.value != 0.0;
      break;
    case ManualSetting::What::kSteer:
      steer_ = setting.value;
      break;
    case ManualSetting::What::kThrottle:
      throttle_ = setting.value;
      break;
  }
  has_news_ = true;
}

model::Command ManualDrive::command(const model::Measurement& now,
                                    const model::VehicleParams& vehicle) noexcept {
  if (std::exchange(has_news_, false)) last_set_ = now.time;
  const double speed = std::isfinite(now.speed) ? std::fabs(now.speed) : kFadeSpeed;
  const double useful = vehicle.brake_throttle_limit;
  double throttle = throttle_;
  if (now.time - last_set_ > kSilenceLimit) {
    throttle = -kGentleBraking * useful * std::min(1.0, speed / kFadeSpeed);
  } else if (throttle < 0.0 && speed >= kFadeSpeed) {
    throttle *= useful;
  }
  return {.steer = steer_ * vehicle.steer_limit, .throttle = throttle};
}

void ManualDrive::restart() noexcept {
  has_news_ = false;
  last_set_ = 0.0;
}

}  // namespace chicane::run
