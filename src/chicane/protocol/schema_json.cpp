// SPDX-License-Identifier: MIT
// The schema as JSON for the dashboard, the controls of a run, and faults as files and command lines write
// them.
#include "chicane/protocol/schema_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "chicane/base/text.hpp"
#include "chicane/protocol/json.hpp"

namespace chicane::protocol {
namespace {

std::string_view name_of(Kind kind) {
  switch (kind) {
    case Kind::kNumber:
      return "number";
    case Kind::kInteger:
      return "integer";
    case Kind::kBool:
      return "bool";
    case Kind::kChoice:
      return "choice";
    case Kind::kText:
      break;
  }
  return "text";
}

std::string_view group_of(std::string_view key) {
  const std::size_t dot = key.find('.');
  return dot == std::string_view::npos ? "run" : key.substr(0, dot);
}

Json to_json(const Value& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag;
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  const double number = std::get<double>(value);
  return std::isfinite(number) ? Json(number) : Json("inf");
}

/// Setting or control as JSON. Kinds without a range have null as their bounds.
Json entry(std::string_view key, const Option& option, const Value& initial) {
  const bool has_range = option.kind == Kind::kNumber || option.kind == Kind::kInteger;
  return {{"key", key},
          {"group", group_of(key)},
          {"kind", name_of(option.kind)},
          {"unit", option.unit.name},
          {"minimum", has_range ? Json(option.minimum) : Json(nullptr)},
          {"maximum", has_range ? Json(option.maximum) : Json(nullptr)},
          {"may_be_infinite", option.may_be_infinite},
          {"choices", option.choices},
          {"default", to_json(initial)},
          {"meaning", option.meaning}};
}

/// Part of the control loop that a fault disturbs.
std::string_view place_of(const sim::FaultKind& kind) {
  if (kind.deadline_questions != nullptr) return "computer";
  if (kind.grip != nullptr || kind.side_acceleration != nullptr) return "road";
  if (kind.actuate != nullptr) return "actuator";
  if (kind.loses_command != nullptr || kind.extra_delay != nullptr) return "link";
  return kind.place == sim::FaultPlace::kLink ? "link" : "sensor";
}

/// Kind of a fault as JSON.
Json described(const sim::FaultKind& kind) {
  Json json{{"group", place_of(kind)}, {"duration_s", kind.duration}};
  json["strength_meaning"] = kind.strength_meaning;
  json["strength"] = kind.strength;
  json["weakest"] = kind.weakest;
  json["strongest"] = kind.strongest;
  return json;
}

/// Shipped names on a shelf, and the chosen one.
Json names_on(Shelf shelf, const std::string& chosen) {
  Json names = Json::array();
  for (const Entry& each : entries(shelf)) names.push_back(each.name);
  if (std::find(names.begin(), names.end(), chosen) == names.end()) names.push_back(chosen);
  return names;
}

}  // namespace

std::optional<Shelf> shelf_of(std::string_view key) {
  if (key == "preset") return Shelf::kPreset;
  if (key == "car") return Shelf::kCar;
  if (key == "track") return Shelf::kTrack;
  return std::nullopt;
}

std::string schema_json(const scenario::Scenario& defaults, const scenario::Scenario& start,
                        const std::function<bool(const Parameter&)>& is_offered,
                        std::span<const Control> controls) {
  Json list = Json::array();
  for (const Parameter& row : protocol::list()) {
    if (!is_offered(row)) continue;
    Json json = entry(row.key, row.option, get(defaults, row));
    json["controller"] = row.controller;
    if (const std::optional<Shelf> shelf = shelf_of(row.key)) {
      json["kind"] = name_of(Kind::kChoice);
      json["choices"] = names_on(*shelf, std::get<std::string>(get(defaults, row)));
    }
    json["start"] = to_json(get(start, row));
    json["is_live"] = is_live(row);
    json["is_fixed"] = is_fixed(row);
    list.push_back(std::move(json));
  }
  for (const Control& control : controls) {
    Json json = entry(control.key, control.option, control.initial);
    json["is_live"] = true;
    if (control.fault != nullptr) json["fault"] = described(*control.fault);
    list.push_back(std::move(json));
  }
  return json_text(list) + "\n";
}

namespace {

constexpr double kLongest = 1e6;  // [s] limit of a fault's times; chosen: longer than any run

/// Number in [low, high] written by `text`; `otherwise` for an empty text.
Result<double> read(std::string_view key, std::string_view text, double low, double high, double otherwise) {
  return text.empty() ? otherwise : number_in(key, text, low, high);
}

}  // namespace

std::string expected_fault(std::string_view word) {
  std::vector<std::string_view> names;
  for (const sim::FaultKind& kind : sim::fault_kinds()) names.push_back(kind.name);
  const std::string_view best = nearest(word, names);
  return best.empty() ? "one of `chicane list faults`"
                      : fmt::format("one of `chicane list faults` (did you mean {}?)", best);
}

Result<sim::FaultEvent> read_fault(const FaultText& text) {
  const std::optional<sim::Fault> fault = sim::fault_named(text.name);
  if (!fault) {
    return fail(refusal("faults.name", text.name, expected_fault(text.name)));
  }
  const sim::FaultKind& kind = sim::kind_of(*fault);
  sim::FaultEvent event = sim::default_event(*fault, 0.0);
  if (text.at.empty()) return fail(refusal("faults.at_s", "", "when it begins [s]"));
  const auto at = read("faults.at_s", text.at, 0.0, kLongest, event.at);
  if (!at) return fail(at.error());
  const auto duration = read("faults.for_s", text.duration, 0.001, kLongest, event.duration);
  if (!duration) return fail(duration.error());
  if (kind.strength_meaning.empty() && !text.strength.empty())
    return fail(
        refusal("faults.strength", text.strength, fmt::format("none: {} has no strength", kind.name)));
  const auto strength = read("faults.strength", text.strength, kind.weakest, kind.strongest, event.strength);
  if (!strength) return fail(strength.error());
  event.at = *at;
  event.duration = *duration;
  event.strength = *strength;
  return event;
}

Result<sim::FaultEvent> parse_fault(std::string_view text) {
  FaultText parts;
  const auto cut = [](std::string_view& rest, char mark) {
    const std::size_t at = rest.find(mark);
    if (at == std::string_view::npos) return std::string{};
    std::string tail(rest.substr(at + 1));
    rest = rest.substr(0, at);
    return tail.empty() ? std::string(1, mark) : tail;  // "x@12+" says a plus and then nothing: no number
  };
  std::string_view rest = text;
  parts.strength = cut(rest, '*');
  parts.duration = cut(rest, '+');
  parts.at = cut(rest, '@');
  parts.name = rest;
  Result<sim::FaultEvent> event = read_fault(parts);
  if (event) return event;
  return fail(ErrorCode::kInvalidArgument,
              fmt::format("--fault {}: {}; written as NAME@SECOND+SECONDS*STRENGTH", printable(text),
                          event.error().message));
}

Result<sim::FaultEvent> read_switch(std::string_view name, std::string_view value) {
  if (value == "true") return parse_fault(fmt::format("{}@0", name));
  if (value.starts_with('+') || value.starts_with('*')) {
    if (const auto event = parse_fault(fmt::format("{}@0{}", name, value))) return event;
  }
  return fail(refusal(fmt::format("fault.{}", printable(name)), value,
                      "true, false or +SECONDS*STRENGTH in the range of `chicane list faults`"));
}

std::string write_fault(const sim::FaultEvent& event) {
  const sim::FaultKind& kind = sim::kind_of(event.fault);
  std::string text = fmt::format("{{name: {}, at_s: {}, for_s: {}", kind.name, event.at, event.duration);
  if (!kind.strength_meaning.empty()) text += fmt::format(", strength: {}", event.strength);
  return text + "}";
}

std::vector<std::string> fault_names() {
  std::vector<std::string> names;
  for (const sim::FaultKind& kind : sim::fault_kinds()) names.emplace_back(kind.name);
  return names;
}

std::vector<Control> fault_controls() {
  static const std::vector<std::string> keys = [] {
    std::vector<std::string> list = fault_names();
    for (std::string& name : list) name.insert(0, "fault.");
    return list;
  }();
  std::vector<Control> controls;
  for (std::size_t i = 0; i < keys.size(); ++i)
    controls.push_back({keys[i], switch_of(sim::fault_kinds()[i].meaning), false, &sim::fault_kinds()[i]});
  return controls;
}

}  // namespace chicane::protocol
