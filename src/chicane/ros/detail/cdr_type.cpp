// SPDX-License-Identifier: MIT
#include "chicane/ros/detail/cdr_type.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <cstring>

namespace chicane::ros {
namespace {

/// A message: Cyclone's part, and the bytes.
struct Message : ddsi_serdata {
  std::string bytes;     ///< padded to a multiple of four, as Cyclone reads that far
  std::size_t size = 0;  ///< without padding
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

/// Fragments may overlap: only what is behind the bytes so far is taken.
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
