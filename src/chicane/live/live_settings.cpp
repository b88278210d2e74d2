// SPDX-License-Identifier: MIT
// Settings of a live run: checks viewers' values, queues them for the control thread, and begins another run
// for values that cannot change during a run.
#include "chicane/live/live_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <variant>

#include "chicane/base/text.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/yaml_codec.hpp"

namespace chicane::live {

Result<std::unique_ptr<BuiltRun>> build_run(ChosenRun run, const Describe& describe) {
  Result<std::unique_ptr<run::ClosedLoop>> loop = run::ClosedLoop::create(run.scenario);
  if (!loop) return fail(loop.error());
  auto built = std::make_unique<BuiltRun>();
  built->description = describe(**loop);
  built->recorded = std::make_unique<const recording::RecordedRun>(
      recording::RecordedRun{.run = built->description, .scenario = std::move(run.scenario)});
  built->loop = std::move(*loop);
  built->choices = std::move(run.choices);
  return built;
}

namespace {

namespace foxglove = protocol::foxglove;
using protocol::Control;
using protocol::Kind;
using protocol::Value;

/// Keys of the world's settings, which a change of the preset leaves as they are.
constexpr std::array<std::string_view, 7> kOfTheWorld{
    "laps", "seed", "latency_ms", "latency_jitter_ms", "time_limit_s", "turn_around_ms", "waypoints_sent"};

bool is_of_the_world(const protocol::Parameter& row) {
  return row.group == "plant_options" || row.group == "sensor" ||
         std::find(kOfTheWorld.begin(), kOfTheWorld.end(), row.key) != kOfTheWorld.end();
}

/// Copies the car of another scenario: its model and its plant.
void take_car(scenario::Scenario& scenario, const scenario::Scenario& from) {
  scenario.vehicle = from.vehicle;
  scenario.friction_low = from.friction_low;
  scenario.plant = from.plant;
  scenario.plant_params = from.plant_params;
}

/// Scenario with the preset, car and track of another one, and nothing else from it.
Result<scenario::Scenario> composed(const scenario::Scenario& of) {
  return protocol::compose(
      {.scenario_file = {}, .settings = {{"preset", of.preset}, {"car", of.car}, {"track", of.track}}});
}

/// Preset `base` with the car, guard, faults and world's settings of `current`.
Result<scenario::Scenario> with_world_of(scenario::Scenario base, const scenario::Scenario& current) {
  base.faults = current.faults;
  base.guard = current.guard;
  take_car(base, current);
  for (const protocol::Parameter& row : protocol::list()) {
    if (!is_of_the_world(row)) continue;
    const Result<void> kept = protocol::set(base, row, protocol::get(current, row));
    if (!kept) return fail(kept.error());
  }
  return base;
}

/// Copies delay and sampling of the car in `base` if its file, or that of the car before, states them.
void take_timing(scenario::Scenario& scenario, const scenario::Scenario& base,
                 const std::string& car_before) {
  scenario::Scenario before = scenario;
  before.car = car_before;
  const Result<scenario::Scenario> old_base = composed(before);
  if (!old_base) return;
  if (old_base->latency != base.latency) scenario.latency = base.latency;
  if (old_base->control_period != base.control_period) scenario.control_period = base.control_period;
}

/// Controls that are no settings of the schema: pace, manual driving and faults.
std::vector<Control> run_controls(bool has_world, const std::vector<Control>& faults) {
  if (!has_world) return {};
  using protocol::number_of;
  std::vector<Control> controls{
      {"run.pace",
       number_of(run::kSlowestPace, run::kFastestPace, "Seconds of the run in a second of the clock."), 1.0},
      {"manual.is_on", protocol::switch_of("A person drives instead of the controller.")},
      {"manual.steer", number_of(-1.0, 1.0, "Share of the steering lock, left positive."), 0.0},
      {"manual.throttle",
       number_of(-1.0, 1.0,
                 "1 is full throttle, -1 all the useful braking; near standstill the reverse gear."),
       0.0}};
  controls.insert(controls.end(), faults.begin(), faults.end());
  return controls;
}

/// Value for viewers. Infinity, which JSON lacks, becomes the text "inf".
foxglove::ParameterValue outside(const Value& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag;
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  const double number = std::get<double>(value);
  if (std::isfinite(number)) return number;
  return std::string("inf");
}

/// Value of a setting from a viewer's message. Fails for lists and for nothing.
Result<Value> inside(std::string_view key, const Option& option, const foxglove::ParameterValue& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return Value(*flag);
  if (const auto* number = std::get_if<double>(&value)) return Value(*number);
  if (const auto* text = std::get_if<std::string>(&value)) return Value(*text);
  const bool is_nothing = std::holds_alternative<std::monostate>(value);
  return fail(refusal(key, is_nothing ? "nothing" : "a list", option));
}

Result<void> validated(const scenario::Scenario& scenario) {
  if (Result<void> valid = model::validate(scenario.vehicle); !valid) return valid;
  for (const protocol::Contradiction& found : protocol::contradictions(scenario))
    return fail(ErrorCode::kInvalidArgument, fmt::format("{}: {}", found.key, found.message));
  return {};
}

/// Choices in words: "track = oval, car = road-car".
std::string words(const std::vector<telemetry::Change>& choices) {
  std::string text;
  for (const telemetry::Change& choice : choices)
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", choice.name.view(), choice.value.view());
  return text;
}

}  // namespace

LiveSettings::LiveSettings(LiveSettingsOptions options, run::SettingQueue& requests)
    : options_{std::move(options)},
      requests_{requests},
      scenario_{options_.scenario},
      base_{composed(scenario_).value_or(scenario_)},
      start_{scenario_},
      controls_{run_controls(options_.has_world, options_.faults)} {
  for (const Control& control : controls_) control_values_.emplace(control.key, control.initial);
  shown_ = list();
}

bool LiveSettings::is_offered(const protocol::Parameter& row) const {
  if (protocol::is_fixed(row)) return true;
  if (!protocol::is_live(row) && !options_.build) return false;
  return options_.has_world || row.controller == scenario_.controller;
}

std::vector<foxglove::Parameter> LiveSettings::list() const {
  std::vector<foxglove::Parameter> all;
  for (const protocol::Parameter& row : protocol::list()) {
    if (is_offered(row)) all.push_back({std::string(row.key), outside(protocol::get(shown_scenario(), row))});
  }
  for (const Control& control : controls_) {
    all.push_back({std::string(control.key), outside(control_values_.find(control.key)->second)});
  }
  return all;
}

std::optional<foxglove::Parameter> LiveSettings::get(std::string_view name) const {
  if (const auto value = control_values_.find(name); value != control_values_.end())
    return foxglove::Parameter{std::string(name), outside(value->second)};
  const protocol::Parameter* row = protocol::find(name);
  if (row == nullptr || !is_offered(*row)) return std::nullopt;
  return foxglove::Parameter{std::string(name), outside(protocol::get(shown_scenario(), *row))};
}

Result<void> LiveSettings::set(const foxglove::Parameter& parameter) {
  const auto* text = std::get_if<std::string>(&parameter.value);
  if (text != nullptr && !decltype(telemetry::Change::value)::fits(*text)) {
    return fail(ErrorCode::kInvalidArgument, fmt::format("{}: got {} bytes, expected at most 256",
                                                         printable(parameter.name), text->size()));
  }
  const auto control = std::find_if(controls_.begin(), controls_.end(),
                                    [&](const Control& each) { return each.key == parameter.name; });
  if (control != controls_.end()) {
    const Result<Value> value = inside(control->key, control->option, parameter.value);
    return value ? set_control(*control, *value) : fail(value.error());
  }
  const protocol::Parameter* row = protocol::find(parameter.name);
  if (row != nullptr && is_offered(*row)) {
    const Result<Value> value = text != nullptr ? protocol::parse(*row, *text)  // "inf"
                                                : inside(row->key, row->option, parameter.value);
    return value ? set_row(*row, *value) : fail(value.error());
  }
  const std::string shown = printable(parameter.name);
  if (row != nullptr) {
    return fail(ErrorCode::kInvalidArgument, fmt::format("{}: cannot be set while this run goes on", shown));
  }
  std::vector<std::string_view> names;
  for (const Control& each : controls_) names.push_back(each.key);
  const std::string_view best = protocol::nearest(parameter.name, names);
  return fail(ErrorCode::kNotFound,
              best.empty() ? fmt::format("{}: {}", shown, protocol::unknown_key(parameter.name))
                           : fmt::format("{}: got an unknown key (did you mean {}?)", shown, best));
}

Result<void> LiveSettings::set_control(const Control& control, const Value& value) {
  const std::string text = protocol::text_of(value);
  if (control.fault == nullptr && std::holds_alternative<std::string>(value))
    return fail(refusal(control.key, printable(text), control.option));
  const Result<run::Setting> setting = run::read_setting({.name = control.key, .value = text});
  if (!setting) return fail(setting.error());
  if (Result<void> sent = send(*setting); !sent) return sent;
  control_values_.find(control.key)->second =
      control.option.kind == Kind::kBool ? Value(text != "false") : value;
  has_news_ = true;
  return {};
}

Result<void> LiveSettings::set_row(const protocol::Parameter& row, const Value& value) {
  scenario::Scenario changed = shown_scenario();
  const Result<run::Setting> setting = run::set_field(changed, row, value);
  if (!setting) return fail(setting.error());
  if (protocol::get(changed, row) == protocol::get(shown_scenario(), row)) return {};
  if (protocol::is_fixed(row)) {
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("{0} is fixed when the run starts; set it on the command line: --set {0}={1}",
                            row.key, setting->change.value.view()));
  }
  if (!protocol::is_live(row)) return start_anew(setting->change, std::move(changed));
  if (Result<void> valid = validated(changed); !valid) return valid;

  scenario::Scenario now = scenario_;
  if (Result<void> valid = protocol::set(now, row, value); !valid) return valid;
  const bool is_other = protocol::get(now, row) != protocol::get(scenario_, row);
  if (is_other && (!building_ || validated(now))) {
    if (Result<void> sent = send(*setting); !sent) return sent;
    scenario_ = std::move(now);
  }
  if (building_) {
    building_->run.scenario = std::move(changed);
    building_->later.insert_or_assign(std::string(row.key), *setting);
  }
  has_news_ = true;
  if (options_.on_accepted) options_.on_accepted(scenario_);
  return {};
}

Result<void> LiveSettings::start_anew(telemetry::Change choice, scenario::Scenario changed) {
  const std::string key(choice.name.view()), value(choice.value.view());
  if (Result<void> chosen = check_choice(key, value); !chosen) return chosen;
  // The queue needs room for the change and for the controls that hand_over_controls() sends.
  if (requests_.room() < 1 + controls_.size())
    return fail(ErrorCode::kInvalidArgument, fmt::format("{}: too many changes wait; try again", key));
  const Result<scenario::Scenario> base = composed(changed);
  if (!base) return hide(fmt::format("{}: {} cannot be used here", key, value), base.error());
  if (key == "preset") {
    Result<scenario::Scenario> fresh = with_world_of(*base, changed);
    if (!fresh) return fail(fresh.error());
    changed = std::move(*fresh);
  } else if (key == "car") {
    take_car(changed, value == options_.scenario.car ? options_.scenario : *base);
    take_timing(changed, *base, shown_scenario().car);
  }
  if (Result<void> valid = validated(changed); !valid) return valid;
  ChosenRun run{.scenario = std::move(changed)};
  if (building_) run.choices = std::move(building_->run.choices);
  std::erase_if(run.choices, [&](const telemetry::Change& each) { return each.name.view() == key; });
  choice.starts_anew = true;
  run.choices.push_back(choice);
  options_.build(run);
  if (options_.on_building) options_.on_building(words(run.choices));
  building_ = Building{.run = std::move(run), .base = *base, .later = {}};
  has_news_ = true;
  return {};
}

Result<void> LiveSettings::check_choice(std::string_view key, const std::string& value) const {
  const std::optional<protocol::Shelf> shelf = protocol::shelf_of(key);
  if (!shelf || value == protocol::get_text(options_.scenario, *protocol::find(key))) return {};
  return protocol::check_name(*shelf, value);
}

tl::unexpected<Error> LiveSettings::hide(std::string_view what, const Error& error) const {
  if (options_.say) options_.say(fmt::format("{}: {}", what, error.message));
  return fail(error.code, fmt::format("{}; the program's own output says why", what));
}

void LiveSettings::update() {
  const bool has_room = building_ && requests_.room() >= 1 + building_->later.size() + controls_.size();
  const auto built = has_room ? options_.built() : std::nullopt;
  if (!built) return;
  Building building = std::move(*building_);
  building_.reset();
  has_news_ = true;
  if (options_.on_building) options_.on_building("");
  if (*built) return hand_over(std::move(building));
  Error error = built->error();
  if (error.code != ErrorCode::kInvalidArgument) error = hide("it cannot be built", error).value();
  complaints_.push_back(
      fmt::format("no run with {}: {}; the one before goes on", words(building.run.choices), error.message));
}

std::vector<std::string> LiveSettings::complaints() { return std::exchange(complaints_, {}); }

void LiveSettings::hand_over(Building building) {
  ++runs_;
  static_cast<void>(send({.change = building.run.choices.back(), .action = {}}));
  for (const auto& [key, setting] : building.later) static_cast<void>(send(setting));
  update_start(building);
  scenario_ = std::move(building.run.scenario);
  base_ = std::move(building.base);
  hand_over_controls();
}

// Settings that come with the choice of a run belong to its start. Settings changed before the choice, or
// during the construction, remain changes. With another preset all settings belong to the start.
void LiveSettings::update_start(const Building& building) {
  const scenario::Scenario& next = building.run.scenario;
  const bool is_other_preset = next.preset != scenario_.preset;
  for (const protocol::Parameter& row : protocol::list()) {
    const bool is_brought = protocol::get_text(next, row) != protocol::get_text(scenario_, row);
    if ((!is_brought && !is_other_preset) || building.later.contains(row.key)) continue;
    static_cast<void>(protocol::set(start_, row, protocol::get(next, row)));
  }
}

void LiveSettings::hand_over_controls() {
  for (const Control& control : controls_) {
    Value& value = control_values_.find(control.key)->second;
    if (control.key.starts_with("fault.")) value = false;
    if (value == control.initial) continue;
    const auto setting = run::read_setting({.name = control.key, .value = protocol::text_of(value)});
    if (setting) static_cast<void>(send(*setting));
  }
}

Result<void> LiveSettings::send(const run::Setting& setting) {
  if (requests_.push(setting)) return {};
  return fail(ErrorCode::kInvalidArgument,
              fmt::format("{}: too many changes wait; try again", setting.change.name.view()));
}

std::vector<telemetry::Change> LiveSettings::applied() {
  std::vector<telemetry::Change> changes;
  while (const telemetry::Change* change = announced_.front()) {
    // Faults also begin and end by themselves; all other changes come from set().
    const auto value = control_values_.find(change->name.view());
    if (value != control_values_.end() && value->first.starts_with("fault.")) {
      value->second = change->value.view() != "false";
      has_news_ = true;
    }
    // The description was made when the run was built: report the scenario of now.
    if (change->starts_anew && options_.on_accepted) options_.on_accepted(scenario_);
    changes.push_back(*change);
    announced_.pop();
  }
  return changes;
}

std::vector<foxglove::Parameter> LiveSettings::news() {
  std::vector<foxglove::Parameter> changed;
  if (!std::exchange(has_news_, false)) return changed;
  std::vector<foxglove::Parameter> now = list();
  for (const foxglove::Parameter& parameter : now) {
    const auto before = std::find_if(shown_.begin(), shown_.end(), [&](const foxglove::Parameter& each) {
      return each.name == parameter.name;
    });
    if (before == shown_.end() || before->value != parameter.value) changed.push_back(parameter);
  }
  shown_ = std::move(now);
  return changed;
}

std::string LiveSettings::schema_json() const {
  return protocol::schema_json(
      base_, start_, [this](const protocol::Parameter& row) { return is_offered(row); }, controls_);
}

std::string LiveSettings::preset_yaml() const {
  return protocol::write_preset(
      scenario_, base_, fmt::format("Settings of a run of {} on {}", scenario_.controller, scenario_.track));
}

}  // namespace chicane::live
