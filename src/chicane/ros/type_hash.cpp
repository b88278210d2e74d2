// SPDX-License-Identifier: MIT
// Names and types of ROS 2 in DDS, and a Cyclone type whose samples are bytes.
#include "chicane/ros/type_hash.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>
#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cstring>
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

/// One definition of a schema: the parts that the hash needs.
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

namespace {

/// A message: Cyclone's part, and the bytes.
struct Message : ddsi_serdata {
  std::string bytes;     ///< padded to a multiple of four, as Cyclone reads that far
  std::size_t size = 0;  ///< size without padding
};

const Message& message_of(const ddsi_serdata* data) { return static_cast<const Message&>(*data); }

Message* new_message(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size) {
  auto* message = new Message;
  ddsi_serdata_init(message, type, kind);
  message->size = size;
  message->bytes.resize((size + 3) / 4 * 4, '\0');
  return message;
}

// Topics without a key: all messages are of one instance.
bool equal_keys(const ddsi_serdata*, const ddsi_serdata*) { return true; }
uint32_t size_of(const ddsi_serdata* data) { return static_cast<uint32_t>(message_of(data).size); }
void free_message(ddsi_serdata* data) { delete static_cast<Message*>(data); }

/// Take only the part beyond the bytes so far: fragments may overlap.
ddsi_serdata* from_network(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* part,
                           std::size_t size) {
  Message* message = new_message(type, kind, size);
  uint32_t at = 0;
  for (; part != nullptr; part = part->nextfrag) {
    if (part->maxp1 <= at) continue;
    const unsigned char* payload = NN_RMSG_PAYLOADOFF(part->rmsg, NN_RDATA_PAYLOAD_OFF(part));
    const std::size_t end = std::min<std::size_t>(part->maxp1, size);
    if (end > at) std::memcpy(message->bytes.data() + at, payload + (at - part->min), end - at);
    at = part->maxp1;
  }
  return message;
}

ddsi_serdata* from_pieces(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                          const ddsrt_iovec_t* pieces, std::size_t size) {
  Message* message = new_message(type, kind, size);
  std::size_t at = 0;
  for (ddsrt_msg_iovlen_t i = 0; i < count && at < size; ++i) {
    const std::size_t length = std::min<std::size_t>(pieces[i].iov_len, size - at);
    std::memcpy(message->bytes.data() + at, pieces[i].iov_base, length);
    at += length;
  }
  return message;
}

ddsi_serdata* from_keyhash(const ddsi_sertype* type, const ddsi_keyhash*) {
  return new_message(type, SDK_KEY, 0);
}

ddsi_serdata* from_sample(const ddsi_sertype* type, ddsi_serdata_kind kind, const void* sample) {
  const auto& bytes = *static_cast<const std::string_view*>(sample);
  if (kind != SDK_DATA) return new_message(type, kind, 0);
  Message* message = new_message(type, kind, bytes.size());
  bytes.copy(message->bytes.data(), bytes.size());
  return message;
}

void to_bytes(const ddsi_serdata* data, std::size_t offset, std::size_t size, void* to) {
  std::memcpy(to, message_of(data).bytes.data() + offset, size);
}

ddsi_serdata* lend_bytes(const ddsi_serdata* data, std::size_t offset, std::size_t size, ddsrt_iovec_t* to) {
  auto* message = static_cast<Message*>(ddsi_serdata_ref(data));
  to->iov_base = message->bytes.data() + offset;
  to->iov_len = size;
  return message;
}
void give_bytes_back(ddsi_serdata* data, const ddsrt_iovec_t*) { ddsi_serdata_unref(data); }

bool to_sample(const ddsi_serdata*, void*, void**, void*) { return true; }
ddsi_serdata* to_untyped(const ddsi_serdata* data) {
  Message* message = new_message(data->type, SDK_KEY, 0);
  message->type = nullptr;
  return message;
}
bool untyped_to_sample(const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) { return true; }
std::size_t print(const ddsi_sertype*, const ddsi_serdata*, char* to, std::size_t size) {
  if (size > 0) *to = '\0';
  return 0;
}
void keyhash(const ddsi_serdata*, ddsi_keyhash* to, bool) { *to = {}; }

ddsi_serdata_ops message_functions() {
  ddsi_serdata_ops ops{};
  ops.eqkey = equal_keys;
  ops.get_size = size_of;
  ops.from_ser = from_network;
  ops.from_ser_iov = from_pieces;
  ops.from_keyhash = from_keyhash;
  ops.from_sample = from_sample;
  ops.to_ser = to_bytes;
  ops.to_ser_ref = lend_bytes;
  ops.to_ser_unref = give_bytes_back;
  ops.to_sample = to_sample;
  ops.to_untyped = to_untyped;
  ops.untyped_to_sample = untyped_to_sample;
  ops.free = free_message;
  ops.print = print;
  ops.get_keyhash = keyhash;
  return ops;
}

void free_type(ddsi_sertype* type) {
  ddsi_sertype_fini(type);
  delete type;
}
void zero_samples(const ddsi_sertype*, void*, std::size_t) {}
/// Nobody takes samples: messages are taken as they are.
void no_samples(void** samples, const ddsi_sertype*, void*, std::size_t, std::size_t count) {
  std::fill_n(samples, count, nullptr);
}
void free_samples(const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {}
/// Types of one name are the same type.
bool equal_types(const ddsi_sertype*, const ddsi_sertype*) { return true; }
uint32_t hash_of_type(const ddsi_sertype*) { return 0; }

ddsi_sertype_ops type_functions() {
  ddsi_sertype_ops ops{};
  ops.version = ddsi_sertype_v0;
  ops.free = free_type;
  ops.zero_samples = zero_samples;
  ops.realloc_samples = no_samples;
  ops.free_samples = free_samples;
  ops.equal = equal_types;
  ops.hash = hash_of_type;
  return ops;
}

}  // namespace

ddsi_sertype* make_cdr_type(const std::string& name) {
  static const ddsi_serdata_ops message = message_functions();
  static const ddsi_sertype_ops functions = type_functions();
  auto* type = new ddsi_sertype{};
  ddsi_sertype_init_flags(type, name.c_str(), &functions, &message, DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  return type;
}

std::string_view bytes_of(const ddsi_serdata& message) {
  const Message& own = message_of(&message);
  return std::string_view(own.bytes).substr(0, own.size);
}

}  // namespace chicane::ros
