// SPDX-License-Identifier: MIT
#include "chicane/protocol/schema_json.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <variant>

#include "chicane/protocol/json.hpp"
#include "chicane/protocol/library.hpp"

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

/// Kinds without a range have none in JSON either.
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

/// Where a fault sits, by what it changes.
std::string_view place_of(const sim::FaultKind& kind) {
  if (kind.deadline_questions != nullptr) return "computer";
  if (kind.grip != nullptr || kind.side_acceleration != nullptr) return "road";
  if (kind.actuate != nullptr) return "actuator";
  if (kind.loses_command != nullptr || kind.extra_delay != nullptr) return "link";
  return kind.place == sim::FaultPlace::kLink ? "link" : "sensor";
}

Json described(const sim::FaultKind& kind) {
  Json json{{"group", place_of(kind)}, {"duration_s", kind.duration}};
  json["strength_meaning"] = kind.strength_meaning;
  json["strength"] = kind.strength;
  json["weakest"] = kind.weakest;
  json["strongest"] = kind.strongest;
  return json;
}

/// What ships, and what is chosen now.
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

}  // namespace chicane::protocol
