// SPDX-License-Identifier: MIT
#include "chicane/ros/type_hash.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "chicane/protocol/ros_messages.hpp"

namespace chicane::ros {
namespace {

/// The numbers of type_description_interfaces/msg/FieldType, rosidl 4.6 (ROS 2 Jazzy).
constexpr std::array<std::pair<std::string_view, int>, 13> kPrimitives{{{"int8", 2},
                                                                        {"uint8", 3},
                                                                        {"int16", 4},
                                                                        {"uint16", 5},
                                                                        {"int32", 6},
                                                                        {"uint32", 7},
                                                                        {"int64", 8},
                                                                        {"uint64", 9},
                                                                        {"float32", 10},
                                                                        {"float64", 11},
                                                                        {"bool", 15},
                                                                        {"byte", 16},
                                                                        {"string", 17}}};
constexpr int kNested = 1;
constexpr int kArray = 48;      // added for a fixed size
constexpr int kSequence = 144;  // added for any size

/// One definition of a schema: what the hash needs of it.
struct Definition {
  std::string fields{};              ///< JSON, one object for each field, joined
  std::vector<std::string> parts{};  ///< types it refers to
};

std::string full_name(std::string_view name) {
  const std::size_t slash = name.find('/');
  if (slash == std::string_view::npos || name.find("/msg/") != std::string_view::npos)
    return std::string(name);
  return fmt::format("{}/msg/{}", name.substr(0, slash), name.substr(slash + 1));
}

std::string_view next_word(std::string_view& line) {
  const std::size_t begin = line.find_first_not_of(' ');
  if (begin == std::string_view::npos) return line = {};
  const std::size_t end = std::min(line.find(' ', begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

void add_field(std::string_view type, std::string_view name, Definition& to) {
  int kind = 0;
  std::string_view capacity = "0";
  if (const std::size_t bracket = type.find('['); bracket != std::string_view::npos) {
    const std::string_view size = type.substr(bracket + 1, type.size() - bracket - 2);
    kind = size.empty() ? kSequence : kArray;
    if (!size.empty()) capacity = size;
    type = type.substr(0, bracket);
  }
  int number = kNested;
  for (const auto& [primitive, value] : kPrimitives)
    if (primitive == type) number = value;
  const std::string nested = number == kNested ? full_name(type) : std::string();
  if (!nested.empty()) to.parts.push_back(nested);
  to.fields += fmt::format(
      R"({}{{"name": "{}", "type": {{"type_id": {}, "capacity": {}, "string_capacity": 0, "nested_type_name": "{}"}}}})",
      to.fields.empty() ? "" : ", ", name, number + kind, capacity, nested);
}

/// Reads "type name", with a default value or a comment behind; constants and empty lines are no fields.
void read_line(std::string_view line, Definition& to) {
  line = line.substr(0, line.find('#'));
  const std::string_view type = next_word(line);
  const std::string_view name = next_word(line);
  const std::string_view rest = next_word(line);
  if (type.empty() || name.find('=') != std::string_view::npos || rest.starts_with('=')) return;
  add_field(type, name, to);
}

std::map<std::string, Definition> read_schema(std::string_view type, std::string_view schema) {
  std::map<std::string, Definition> found;
  Definition* current = &found[std::string(type)];
  while (!schema.empty()) {
    const std::size_t end = std::min(schema.find('\n'), schema.size());
    const std::string_view line = schema.substr(0, end);
    schema.remove_prefix(std::min(end + 1, schema.size()));
    if (line.starts_with("MSG: ")) {
      current = &found[full_name(line.substr(5))];
    } else if (!line.starts_with("====")) {
      read_line(line, *current);
    }
  }
  return found;
}

std::string described(std::string_view name, const Definition& definition) {
  return fmt::format(R"({{"type_name": "{}", "fields": [{}]}})", name, definition.fields);
}

}  // namespace

std::string dds_topic(std::string_view topic) {
  return (topic.starts_with('/') ? "rt" : "") + std::string(topic);
}

std::string dds_type(std::string_view type) {
  std::string name;
  const std::size_t last = type.rfind('/');
  for (const char c : type.substr(0, last)) name += c == '/' ? "::" : std::string(1, c);
  return fmt::format("{}::dds_::{}_", name, type.substr(last + 1));
}

std::string ros_topic(std::string_view topic) {
  return std::string(topic.starts_with("rt/") ? topic.substr(2) : topic);
}

std::string ros_type(std::string_view type) {
  constexpr std::string_view kMark = "::dds_::";
  const std::size_t at = type.find(kMark);
  if (at == std::string_view::npos || !type.ends_with('_')) return std::string(type);
  std::string name(type.substr(0, at));
  if (const std::size_t colons = name.find("::"); colons != std::string::npos) name.replace(colons, 2, "/");
  const std::string_view last = type.substr(at + kMark.size());
  return fmt::format("{}/{}", name, last.substr(0, last.size() - 1));
}

std::string type_description(std::string_view type, std::string_view schema) {
  const std::map<std::string, Definition> definitions = read_schema(type, schema);
  std::string parts;
  for (const auto& [name, definition] : definitions) {  // a map: by name, as the hash wants it
    if (name != type) parts += (parts.empty() ? "" : ", ") + described(name, definition);
  }
  return fmt::format(R"({{"type_description": {}, "referenced_type_descriptions": [{}]}})",
                     described(type, definitions.at(std::string(type))), parts);
}

std::string type_hash(std::string_view type) {
  const std::string schema = protocol::ros_schema(type);
  if (schema.empty()) return {};
  const std::string text = type_description(type, schema);
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (EVP_Digest(text.data(), text.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) return {};
  std::string hash = "RIHS01_";
  for (unsigned i = 0; i < size; ++i) hash += fmt::format("{:02x}", digest[i]);
  return hash;
}

}  // namespace chicane::ros
