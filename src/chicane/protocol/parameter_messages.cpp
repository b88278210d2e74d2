// SPDX-License-Identifier: MIT
#include "chicane/protocol/parameter_messages.hpp"

#include <cmath>
#include <utility>
#include <variant>

#include "chicane/protocol/detail/cdr_source.hpp"
#include "chicane/protocol/detail/cdr_writer.hpp"
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

CdrWriter reply_to(const ServiceCall& call) {
  CdrWriter to{512};
  to.put(call.client, call.sequence);
  return to;
}

ServiceCall get_call(CdrSource& from) {
  ServiceCall call;
  call.client = from.get<std::uint64_t>();
  call.sequence = from.get<std::int64_t>();
  return call;
}

/// rcl_interfaces/msg/ParameterValue: all kinds of value, of which `type` says the one that holds.
void put_value(CdrWriter& to, const Setting& parameter) {
  const Type type = type_of(parameter);
  const auto* number = std::get_if<double>(&parameter.value);
  const auto* flag = std::get_if<bool>(&parameter.value);
  const auto* text = std::get_if<std::string>(&parameter.value);
  to.put(static_cast<std::uint8_t>(type), flag != nullptr && *flag,
         type == Type::kInteger ? static_cast<std::int64_t>(std::llround(*number)) : std::int64_t{0},
         type == Type::kDouble ? *number : 0.0);
  to.text(text != nullptr ? *text : std::string());
  for (int array = 0; array < 5; ++array) to.count(0);
}

ParameterValue get_value(CdrSource& from) {
  const auto type = static_cast<Type>(from.get<std::uint8_t>());
  const bool flag = from.flag();
  const auto integer = from.get<std::int64_t>();
  const double number = from.number();
  std::string text(from.text());
  for (std::uint32_t i = from.count(1); i > 0; --i) from.get<std::uint8_t>();
  for (std::uint32_t i = from.count(1); i > 0; --i) from.flag();
  for (std::uint32_t i = from.count(8); i > 0; --i) from.get<std::int64_t>();
  for (std::uint32_t i = from.count(8); i > 0; --i) from.number();
  for (std::uint32_t i = from.count(4); i > 0; --i) from.text();
  switch (type) {
    case Type::kBool:
      return flag;
    case Type::kInteger:
      return static_cast<double>(integer);
    case Type::kDouble:
      return number;
    case Type::kString:
      return text;
    default:
      return std::monostate{};
  }
}

std::vector<std::string> get_texts(CdrSource& from) {
  std::vector<std::string> texts;
  for (std::uint32_t i = from.count(4); i > 0 && from.ok(); --i) texts.emplace_back(from.text());
  return texts;
}

template <class Content>
std::optional<Content> if_ok(const CdrSource& from, Content content) {
  if (!from.ok()) return std::nullopt;
  return content;
}

/// rcl_interfaces/msg/ParameterDescriptor.
void put_descriptor(CdrWriter& to, const Setting& parameter) {
  const Type type = type_of(parameter);
  const auto* row = find(parameter.name);
  std::string meaning;
  if (row != nullptr) meaning = std::string(row->option.meaning);
  if (row != nullptr && !row->option.unit.name.empty())
    meaning += " [" + std::string(row->option.unit.name) + "]";
  to.text(parameter.name).put(static_cast<std::uint8_t>(type)).text(meaning).text("");
  to.put(row != nullptr && is_fixed(*row), false);
  const bool has_range =
      row != nullptr && std::isfinite(row->option.minimum) && std::isfinite(row->option.maximum);
  to.count(has_range && type == Type::kDouble ? 1 : 0);
  if (has_range && type == Type::kDouble) to.put(row->option.minimum, row->option.maximum, 0.0);
  to.count(has_range && type == Type::kInteger ? 1 : 0);
  if (has_range && type == Type::kInteger) {
    to.put(static_cast<std::int64_t>(row->option.minimum), static_cast<std::int64_t>(row->option.maximum),
           std::uint64_t{1});
  }
}

}  // namespace

std::string encode_names_request(const NamesRequest& request) {
  return reply_to(request.call).texts(request.names).put(std::uint64_t{0}).bytes();
}

std::optional<NamesRequest> decode_names_request(std::string_view bytes) {
  CdrSource from(bytes);
  NamesRequest request{.call = get_call(from)};
  request.names = get_texts(from);
  return if_ok(from, std::move(request));
}

std::string encode_set_request(const SetRequest& request) {
  CdrWriter to = reply_to(request.call);
  to.count(request.parameters.size());
  for (const Setting& each : request.parameters) {
    to.text(each.name);
    put_value(to, each);
  }
  return to.bytes();
}

std::optional<SetRequest> decode_set_request(std::string_view bytes) {
  constexpr std::size_t kSmallest = 40;
  CdrSource from(bytes);
  SetRequest request{.call = get_call(from)};
  for (std::uint32_t i = from.count(kSmallest); i > 0 && from.ok(); --i) {
    std::string name(from.text());
    request.parameters.push_back({.name = std::move(name), .value = get_value(from)});
  }
  return if_ok(from, std::move(request));
}

std::string encode_set_reply(const ServiceCall& call, const std::vector<SetOutcome>& outcomes) {
  CdrWriter to = reply_to(call);
  to.count(outcomes.size());
  for (const SetOutcome& each : outcomes) to.put(each.is_successful).text(each.reason);
  return to.bytes();
}

std::optional<std::vector<SetOutcome>> decode_set_reply(std::string_view bytes) {
  CdrSource from(bytes);
  get_call(from);
  std::vector<SetOutcome> outcomes;
  for (std::uint32_t i = from.count(5); i > 0 && from.ok(); --i) {
    const bool is_successful = from.flag();
    outcomes.push_back({is_successful, std::string(from.text())});
  }
  return if_ok(from, std::move(outcomes));
}

std::string encode_list_reply(const ServiceCall& call, const std::vector<std::string>& names) {
  return reply_to(call).texts(names).count(0).bytes();
}

std::optional<std::vector<std::string>> decode_list_reply(std::string_view bytes) {
  CdrSource from(bytes);
  get_call(from);
  std::vector<std::string> names = get_texts(from);
  return if_ok(from, std::move(names));
}

std::string encode_get_reply(const ServiceCall& call, const std::vector<Setting>& values) {
  CdrWriter to = reply_to(call);
  to.count(values.size());
  for (const Setting& each : values) put_value(to, each);
  return to.bytes();
}

std::optional<std::vector<ParameterValue>> decode_get_reply(std::string_view bytes) {
  CdrSource from(bytes);
  get_call(from);
  std::vector<ParameterValue> values;
  for (std::uint32_t i = from.count(32); i > 0 && from.ok(); --i) values.push_back(get_value(from));
  return if_ok(from, std::move(values));
}

std::string encode_describe_reply(const ServiceCall& call, const std::vector<Setting>& values) {
  CdrWriter to = reply_to(call);
  to.count(values.size());
  for (const Setting& each : values) put_descriptor(to, each);
  return to.bytes();
}

}  // namespace chicane::protocol
