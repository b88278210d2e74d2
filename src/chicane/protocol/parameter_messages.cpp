// SPDX-License-Identifier: MIT
#include "chicane/protocol/parameter_messages.hpp"

#include <cmath>
#include <utility>
#include <variant>

#include "chicane/protocol/schema.hpp"

namespace chicane::protocol {
namespace {

using Setting = foxglove::Parameter;
using foxglove::ParameterValue;

// rcl_interfaces/msg/ParameterType.
enum class Type : std::uint8_t { kNotSet = 0, kBool = 1, kInteger = 2, kDouble = 3, kString = 4 };

Type type_of(const Setting& parameter) {
  if (std::holds_alternative<bool>(parameter.value)) return Type::kBool;
  if (std::holds_alternative<std::string>(parameter.value)) return Type::kString;
  if (!std::holds_alternative<double>(parameter.value)) return Type::kNotSet;
  const auto* row = find(parameter.name);
  return row != nullptr && row->option.kind == OptionKind::kInteger ? Type::kInteger : Type::kDouble;
}

}  // namespace

/// rcl_interfaces/msg/ParameterValue: all kinds of value, of which the first number says the one that holds.
void value_fields(WritingArchive& archive, const Setting& parameter) {
  const Type type = type_of(parameter);
  const auto* number = std::get_if<double>(&parameter.value);
  const auto* flag = std::get_if<bool>(&parameter.value);
  const auto* text = std::get_if<std::string>(&parameter.value);
  archive(static_cast<std::uint8_t>(type), flag != nullptr && *flag,
          type == Type::kInteger ? static_cast<std::int64_t>(std::llround(*number)) : std::int64_t{0},
          type == Type::kDouble ? *number : 0.0, text != nullptr ? *text : std::string());
  for (int array = 0; array < 5; ++array) archive(std::uint32_t{0});
}

void value_fields(ReadingArchive& archive, Setting& parameter) {
  std::uint8_t type = 0;
  bool flag = false;
  std::int64_t integer = 0;
  double number = 0.0;
  std::string text;
  archive(type, flag, integer, number, text);
  archive.skip_list<std::uint8_t>();
  archive.skip_list<std::uint8_t>();
  archive.skip_list<std::int64_t>();
  archive.skip_list<double>();
  std::vector<std::string> texts;
  archive(texts);
  switch (static_cast<Type>(type)) {
    case Type::kBool:
      parameter.value = flag;
      break;
    case Type::kInteger:
      parameter.value = static_cast<double>(integer);
      break;
    case Type::kDouble:
      parameter.value = number;
      break;
    case Type::kString:
      parameter.value = text;
      break;
    default:
      parameter.value = std::monostate{};
  }
}

/// rcl_interfaces/msg/ParameterDescriptor.
void descriptor_fields(WritingArchive& archive, const Setting& parameter) {
  const Type type = type_of(parameter);
  const auto* row = find(parameter.name);
  std::string meaning;
  if (row != nullptr) meaning = std::string(row->option.meaning);
  if (row != nullptr && !row->option.unit.name.empty())
    meaning += " [" + std::string(row->option.unit.name) + "]";
  archive(parameter.name, static_cast<std::uint8_t>(type), meaning, std::string(),
          row != nullptr && is_fixed(*row), false);
  const bool has_range =
      row != nullptr && std::isfinite(row->option.minimum) && std::isfinite(row->option.maximum);
  archive(std::uint32_t{has_range && type == Type::kDouble});
  if (has_range && type == Type::kDouble) archive(row->option.minimum, row->option.maximum, 0.0);
  archive(std::uint32_t{has_range && type == Type::kInteger});
  if (has_range && type == Type::kInteger)
    archive.as<std::int64_t>(row->option.minimum, row->option.maximum, 1);
}

}  // namespace chicane::protocol
