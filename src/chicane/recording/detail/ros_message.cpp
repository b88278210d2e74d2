// SPDX-License-Identifier: MIT
// Reader of ROS 2 messages by the definition in their recording: parses the definition to fields by type,
// then walks the CDR bytes field by field.
#include "chicane/recording/detail/ros_message.hpp"

#include <fmt/format.h>

#include <sstream>
#include <utility>

#include "chicane/protocol/car_messages.hpp"

namespace chicane::recording {
namespace {

// Chosen: a recording may be forged.
constexpr int kMostDepth = 8;                     // limit of messages within messages
constexpr std::size_t kMostElements = 1U << 20U;  // limit of a list's elements

}  // namespace

double RosContent::number(std::string_view name, double missing) const {
  const auto found = numbers.find(name);
  return found == numbers.end() || found->second.empty() ? missing : found->second.front();
}

std::string RosContent::text(std::string_view name) const {
  const auto found = texts.find(name);
  return found == texts.end() || found->second.empty() ? std::string() : found->second.front();
}

const std::vector<double>& RosContent::list(std::string_view name) const {
  static const std::vector<double> kNone;
  const auto found = numbers.find(name);
  return found == numbers.end() ? kNone : found->second;
}

Result<RosReader> RosReader::create(std::string_view definition) {
  RosReader reader;
  std::istringstream lines{std::string(definition)};
  std::string type;
  reader.types_[""];
  for (std::string line; std::getline(lines, line);) {
    line = line.substr(0, line.find('#'));
    std::istringstream words(line);
    std::string first, second, third;
    words >> first >> second >> third;
    if (first.empty() || first.starts_with("==")) continue;
    if (first == "MSG:") {
      if (!second.empty()) type = second;
      reader.types_[type];
      continue;
    }
    if (second.find('=') != std::string::npos || third.starts_with("=")) continue;  // a constant
    reader.types_[type].push_back(field_of(std::move(first), std::move(second)));
  }
  // The types of all fields must be defined.
  for (const auto& [name, fields] : reader.types_) {
    for (const Field& field : fields) {
      const bool is_message =
          field.type.find('/') != std::string::npos && !field.type.starts_with("builtin_interfaces/");
      if (is_message && !reader.types_.contains(field.type))
        return fail(ErrorCode::kParse, field.type + ": got no definition");
    }
  }
  return reader;
}

RosReader::Field RosReader::field_of(std::string type, std::string name) {
  Field field{.type = std::move(type), .name = std::move(name)};
  const std::size_t open = field.type.find('[');
  if (open == std::string::npos) return field;
  // An array: "[]" has its count in the message, "[3]" a fixed one.
  const std::string inside = field.type.substr(open + 1, field.type.find(']') - open - 1);
  field.many = inside.empty() ? Field::Many::kCounted : Field::Many::kFixed;
  field.count = 0;
  for (const char digit : inside)
    if (digit >= '0' && digit <= '9' && field.count < kMostElements)
      field.count = 10 * field.count + static_cast<std::size_t>(digit - '0');
  field.type.erase(open);
  return field;
}

bool RosReader::read_type(const std::string& type, const std::string& name, protocol::CdrSource& source,
                          int depth, RosContent& content) const {
  if (type == "string") {
    content.texts[name].emplace_back(source.text());
    return source.ok();
  }
  const auto keep = [&](auto value) {
    content.numbers[name].push_back(static_cast<double>(value));
    return source.ok();
  };
  if (type == "builtin_interfaces/Time" || type == "builtin_interfaces/Duration") {
    const double seconds = source.get<std::int32_t>();
    return keep(seconds + 1e-9 * source.get<std::uint32_t>());
  }
  if (type == "float64") return keep(source.get<double>());
  if (type == "float32") return keep(source.get<float>());
  if (type == "bool" || type == "uint8" || type == "byte") return keep(source.get<std::uint8_t>());
  if (type == "int8") return keep(source.get<std::int8_t>());
  if (type == "uint16") return keep(source.get<std::uint16_t>());
  if (type == "int16") return keep(source.get<std::int16_t>());
  if (type == "uint32") return keep(source.get<std::uint32_t>());
  if (type == "int32") return keep(source.get<std::int32_t>());
  if (type == "uint64") return keep(source.get<std::uint64_t>());
  if (type == "int64") return keep(source.get<std::int64_t>());
  // Any other type is a message: read its fields in turn.
  const auto fields = types_.find(type);
  if (fields == types_.end() || depth > kMostDepth) return false;
  for (const Field& field : fields->second) {
    const std::size_t count = field.many == Field::Many::kCounted ? source.count(1) : field.count;
    if (count > kMostElements) return false;
    const std::string path = name.empty() ? field.name : name + "." + field.name;
    for (std::size_t i = 0; i < count; ++i)
      if (!read_type(field.type, path, source, depth + 1, content)) return false;
  }
  return source.ok();
}

Result<RosContent> RosReader::read(std::string_view bytes) const {
  RosContent content;
  protocol::CdrSource source(bytes);
  if (!read_type("", "", source, 0, content))
    return fail(ErrorCode::kParse, "got a message that is cut short, or not in plain CDR");
  return content;
}

Result<RosContent> RosReaders::read(const telemetry::McapMessage& message) {
  auto reader = readers_.find(message.channel.id);
  if (reader == readers_.end()) {
    Result<RosReader> made = RosReader::create(message.channel.schema);
    if (!made) return fail(made.error());
    reader = readers_.emplace(message.channel.id, std::move(*made)).first;
  }
  Result<RosContent> content = reader->second.read(message.bytes);
  if (content) return content;
  return fail(content.error().code, fmt::format("{}: {}", message.channel.topic, content.error().message));
}

}  // namespace chicane::recording
