// SPDX-License-Identifier: MIT
// Reading, writing and checking of options by their rows.
#include "chicane/base/option.hpp"

#include <limits>

#include "chicane/base/text.hpp"

namespace chicane {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Whether `value`, in the option's unit, is allowed; false for not-a-number.
bool is_in_range(const Option& option, double value) {
  return (value >= option.minimum && value <= option.maximum) ||
         (option.may_be_infinite && value == kInfinity);
}

Result<void> set_number(const Option& option, std::string_view key, void* owner, double value) {
  const bool is_number = option.kind == OptionKind::kNumber;
  const bool is_integer = option.kind == OptionKind::kInteger && value == std::floor(value);
  if (!(is_number || is_integer) || !is_in_range(option, value))
    return fail(refusal(key, number_text(value), option));
  option.write(owner, option.unit.to_si(value));
  return {};
}

Result<void> set_text(const Option& option, std::string_view key, void* owner, const std::string& text) {
  if (option.kind == OptionKind::kText && !text.empty()) {
    option.write(owner, text);
    return {};
  }
  const auto choice = std::find(option.choices.begin(), option.choices.end(), text);
  if (choice == option.choices.end()) return fail(refusal(key, printable(text), option));
  const bool is_enum = std::holds_alternative<double>(option.read(owner));
  option.write(
      owner, is_enum ? OptionValue(static_cast<double>(choice - option.choices.begin())) : OptionValue(text));
  return {};
}

/// Whether `value`, as Option::read() returns it, is one that set() accepts.
bool is_valid(const Option& option, const OptionValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) {
    return option.kind == OptionKind::kText ||
           std::find(option.choices.begin(), option.choices.end(), *text) != option.choices.end();
  }
  const auto* number = std::get_if<double>(&value);
  if (number == nullptr) return true;
  if (option.kind == OptionKind::kChoice)
    return *number >= 0.0 && *number < static_cast<double>(option.choices.size());
  // Compares in SI, as set() stores values: conversion rounds the value and its bounds alike.
  return (*number >= option.unit.to_si(option.minimum) && *number <= option.unit.to_si(option.maximum)) ||
         (option.may_be_infinite && *number == kInfinity);
}

}  // namespace

std::string option_key(std::string_view group, const Option& option) {
  std::string key(group);
  if (!group.empty()) key += '.';
  return key.append(option.name).append(option.unit.suffix);
}

std::string expectation(const Option& option) {
  const auto range = [&] {
    const std::string unit = option.unit.name.empty() ? "" : " " + std::string(option.unit.name);
    return "in [" + number_text(option.minimum) + ", " + number_text(option.maximum) + "]" + unit +
           (option.may_be_infinite ? " or inf" : "");
  };
  switch (option.kind) {
    case OptionKind::kNumber:
      return "a number " + range();
    case OptionKind::kInteger:
      return "an integer " + range();
    case OptionKind::kBool:
      return "true or false";
    case OptionKind::kChoice:
      return "one of " + joined(option.choices);
    case OptionKind::kText:
      break;
  }
  return "text";
}

Error refusal(std::string_view key, std::string_view got, const Option& option) {
  return {ErrorCode::kInvalidArgument,
          std::string(key).append(": got ").append(got).append(", expected ").append(expectation(option))};
}

OptionValue get(const Option& option, const void* owner) {
  OptionValue value = option.read(owner);
  const auto* number = std::get_if<double>(&value);
  if (number == nullptr) return value;
  if (option.kind == OptionKind::kChoice)
    return std::string(option.choices[static_cast<std::size_t>(*number)]);
  return option.unit.from_si(*number);
}

Result<void> set(const Option& option, std::string_view key, void* owner, const OptionValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return set_number(option, key, owner, *number);
  if (const auto* text = std::get_if<std::string>(&value)) return set_text(option, key, owner, *text);
  const bool flag = std::get<bool>(value);
  if (option.kind != OptionKind::kBool) return fail(refusal(key, flag ? "true" : "false", option));
  option.write(owner, flag);
  return {};
}

Result<void> check_options(std::string_view group, std::span<const Option> options, const void* owner) {
  for (const Option& option : options) {
    if (is_valid(option, option.read(owner))) continue;
    const OptionValue value = option.read(owner);
    const auto* number = std::get_if<double>(&value);  // null for a text: a bool is always valid
    return fail(refusal(option_key(group, option),
                        number != nullptr ? number_text(option.unit.from_si(*number))
                                          : printable(std::get<std::string>(value)),
                        option));
  }
  return {};
}

}  // namespace chicane
