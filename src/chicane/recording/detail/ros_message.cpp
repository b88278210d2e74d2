// SPDX-License-Identifier: MIT
// Reader of ROS 2 messages by the definition in their recording: parses the definition to fields by type,
// then walks the CDR bytes field by field.
#include "chicane/recording/detail/ros_message.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <sstream>
#include <utility>

namespace chicane::recording {
namespace {

constexpr int kMostDepth = 8;                     // limit of nested messages
constexpr std::size_t kMostElements = 1U << 20U;  // limit of a list's elements and a text's bytes

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

/// Read position in the bytes of a message. A read beyond their end fails, and so do all later ones.
class RosReader::Cursor {
 public:
  explicit Cursor(std::string_view bytes) : bytes_{bytes} {}

  template <class T>
  bool get(double& value) {
    T raw{};
    if (!take(&raw, sizeof raw)) return false;
    value = static_cast<double>(raw);
    return true;
  }
  bool count(std::size_t& value) {
    std::uint32_t raw = 0;
    if (!take(&raw, sizeof raw) || raw > kMostElements) return false;
    value = raw;
    return true;
  }
  bool text(std::string& value) {
    std::size_t size = 0;
    if (!count(size) || size > bytes_.size() - at_) return false;
    value = std::string(bytes_.substr(at_, size > 0 ? size - 1 : 0));
    at_ += size;
    return true;
  }

 private:
  static constexpr std::size_t kHeader = 4;  ///< encapsulation header [byte]

  bool take(void* to, std::size_t size) {
    at_ = kHeader + (at_ - kHeader + size - 1) / size * size;
    if (at_ > bytes_.size() || size > bytes_.size() - at_) return false;
    std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
    return true;
  }

  std::string_view bytes_;
  std::size_t at_ = kHeader;
};

Result<RosReader> RosReader::create(std::string_view definition) {
  RosReader reader;
  std::istringstream lines{std::string(definition)};
  std::string type;
  reader.types_[""];
  for (std::string line; std::getline(lines, line);) {
    line = line.substr(0, line.find('#'));
    std::istringstream words(line);
    Field field;
    if (!(words >> field.type)) continue;
    if (field.type.starts_with("==")) continue;
    if (field.type == "MSG:") {
      words >> type;
      reader.types_[type];
      continue;
    }
    words >> field.name;
    std::string rest;
    words >> rest;
    if (field.name.find('=') != std::string::npos || rest.starts_with("=")) continue;  // a constant
    // An array: "[]" is counted in the message, "[3]" is fixed.
    if (const std::size_t open = field.type.find('['); open != std::string::npos) {
      const std::string inside = field.type.substr(open + 1, field.type.find(']') - open - 1);
      field.many = inside.empty() ? Field::Many::kCounted : Field::Many::kFixed;
      field.count = 0;
      for (const char digit : inside)
        if (digit >= '0' && digit <= '9' && field.count < kMostElements)
          field.count = 10 * field.count + static_cast<std::size_t>(digit - '0');
      field.type.erase(open);
    }
    reader.types_[type].push_back(std::move(field));
  }
  // Every type that a field has must be defined.
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

bool RosReader::read_type(const std::string& type, const std::string& name, Cursor& cursor, int depth,
                          RosContent& content) const {
  if (type == "string") {
    std::string text;
    if (!cursor.text(text)) return false;
    content.texts[name].push_back(std::move(text));
    return true;
  }
  double value = 0.0;
  const auto keep = [&](bool is_there) {
    if (is_there) content.numbers[name].push_back(value);
    return is_there;
  };
  if (type == "builtin_interfaces/Time" || type == "builtin_interfaces/Duration") {
    double nanoseconds = 0.0;
    if (!cursor.get<std::int32_t>(value) || !cursor.get<std::uint32_t>(nanoseconds)) return false;
    value += 1e-9 * nanoseconds;
    return keep(true);
  }
  if (type == "float64") return keep(cursor.get<double>(value));
  if (type == "float32") return keep(cursor.get<float>(value));
  if (type == "bool" || type == "uint8" || type == "byte") return keep(cursor.get<std::uint8_t>(value));
  if (type == "int8") return keep(cursor.get<std::int8_t>(value));
  if (type == "uint16") return keep(cursor.get<std::uint16_t>(value));
  if (type == "int16") return keep(cursor.get<std::int16_t>(value));
  if (type == "uint32") return keep(cursor.get<std::uint32_t>(value));
  if (type == "int32") return keep(cursor.get<std::int32_t>(value));
  if (type == "uint64") return keep(cursor.get<std::uint64_t>(value));
  if (type == "int64") return keep(cursor.get<std::int64_t>(value));
  // A message: its fields in turn.
  const auto fields = types_.find(type);
  if (fields == types_.end() || depth > kMostDepth) return false;
  for (const Field& field : fields->second) {
    std::size_t count = field.count;
    if (field.many == Field::Many::kCounted && !cursor.count(count)) return false;
    const std::string path = name.empty() ? field.name : name + "." + field.name;
    for (std::size_t i = 0; i < count; ++i)
      if (!read_type(field.type, path, cursor, depth + 1, content)) return false;
  }
  return true;
}

Result<RosContent> RosReader::read(std::string_view bytes) const {
  RosContent content;
  Cursor cursor(bytes);
  if (!read_type("", "", cursor, 0, content))
    return fail(ErrorCode::kParse, "got a message that ends too early");
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
