// SPDX-License-Identifier: MIT
// Names and types of ROS 2 in DDS, and a type of Cyclone DDS whose samples are bytes.
#include "chicane/ros/cdr_type.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/ddsi_tran.h>
#include <dds/ddsi/q_radmin.h>
#include <fmt/format.h>

// ddsi_domaingv.h includes q_sockwaitset.h, which is no C++: a structure and a pointer to it have one name
// there.
#define Q_SOCKWAITSET_H
using os_sockWaitset = struct SocketWaitset*;
#include <dds/ddsi/ddsi_domaingv.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace chicane::ros {

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

namespace {

// Numbers of the RTPS protocol, version 2.3.
// Heads of the parameter that names the request of a reply (9.4.2.11): 16 bytes of a GUID and 8 of a number.
// Fast DDS reads the first one, since version 3 also the second.
constexpr std::array<std::string_view, 2> kCallMarks{{{"\x0f\x80\x18\0", 4}, {"\x83\0\x18\0", 4}}};
constexpr std::string_view kLastParameter{"\x01\0\0\0", 4};      // end of the parameters
constexpr std::size_t kGuid = 16, kNumber = 8;                   // [byte] sizes of the two parts of a call
constexpr std::size_t kDataHeader = 24;                          // [byte] header of a message
constexpr std::uint8_t kIsLittleEndian = 1, kHasParameters = 2;  // flags of that header

/// Message: Cyclone's part, and the bytes.
struct Message : ddsi_serdata {
  std::string bytes;           ///< padded to a multiple of four, because Cyclone reads that far
  std::size_t size = 0;        ///< size without padding [byte]
  std::size_t parameters = 0;  ///< size of the parameters before the CDR part [byte]
  std::string call{};          ///< Sample::call of a request
};

const Message& message_of(const ddsi_serdata* data) { return static_cast<const Message&>(*data); }

/// Empty message for `size` bytes.
Message* new_message(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size) {
  auto* message = new Message;
  ddsi_serdata_init(message, type, kind);
  message->size = size;
  message->bytes.resize((size + 3) / 4 * 4, '\0');
  return message;
}

std::uint16_t number_at(const unsigned char* bytes) {
  std::uint16_t number = 0;
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

/// Call of a request: the GUID that the reply has to name, and the number of the message. Empty without one.
std::string call_in(const nn_rdata& part) {
  const unsigned char* at = NN_RMSG_PAYLOADOFF(part.rmsg, NN_RDATA_SUBMSG_OFF(&part));
  const unsigned char* end = NN_RMSG_PAYLOADOFF(part.rmsg, NN_RDATA_PAYLOAD_OFF(&part));
  if ((at[1] & kHasParameters) == 0 || (at[1] & kIsLittleEndian) == 0) return {};
  const unsigned char* next = at + 8 + number_at(at + 6);
  for (; next + 4 <= end && next + 4 + number_at(next + 2) <= end; next += 4 + number_at(next + 2)) {
    for (const std::string_view mark : kCallMarks) {
      if (std::memcmp(next, mark.data(), mark.size()) != 0) continue;
      std::string call(next + 4, next + 4 + kGuid);
      return call.append(at + kGuid, at + kGuid + kNumber);
    }
  }
  return {};
}

// Functions that Cyclone calls for messages of this type.

/// Message from its fragments, which may overlap.
ddsi_serdata* from_network(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* part,
                           std::size_t size) {
  Message* message = new_message(type, kind, size);
  if (part != nullptr) message->call = call_in(*part);
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

/// Message from an OutgoingMessage: parameters with the call, if there is one, then the bytes.
ddsi_serdata* from_sample(const ddsi_sertype* type, ddsi_serdata_kind kind, const void* sample) {
  const auto& outgoing = *static_cast<const OutgoingMessage*>(sample);
  if (kind != SDK_DATA) return new_message(type, kind, 0);
  std::string bytes;
  if (!outgoing.call.empty()) {
    for (const std::string_view mark : kCallMarks) bytes.append(mark).append(outgoing.call);
    bytes.append(kLastParameter);
  }
  const std::size_t parameters = bytes.size();
  bytes.append(outgoing.bytes);
  Message* message = new_message(type, kind, bytes.size());
  bytes.copy(message->bytes.data(), bytes.size());
  message->parameters = parameters;
  return message;
}

/// Lends a part of a message's bytes to Cyclone, which keeps a reference to the message meanwhile.
ddsi_serdata* lend_bytes(const ddsi_serdata* data, std::size_t offset, std::size_t size, ddsrt_iovec_t* to) {
  auto* message = static_cast<Message*>(ddsi_serdata_ref(data));
  to->iov_base = message->bytes.data() + offset;
  to->iov_len = size;
  return message;
}

/// Message with the key only, which is empty.
ddsi_serdata* to_untyped(const ddsi_serdata* data) {
  Message* message = new_message(data->type, SDK_KEY, 0);
  message->type = nullptr;
  return message;
}

ddsi_serdata_ops message_functions() {
  using Type = const ddsi_sertype*;
  using Data = const ddsi_serdata*;
  ddsi_serdata_ops ops{};
  ops.eqkey = [](Data, Data) { return true; };  // topics without a key: all messages are of one instance
  ops.get_size = [](Data data) { return static_cast<uint32_t>(message_of(data).size); };
  ops.from_ser = from_network;
  ops.from_keyhash = [](Type type, const ddsi_keyhash*) -> ddsi_serdata* {
    return new_message(type, SDK_KEY, 0);
  };
  ops.from_sample = from_sample;
  ops.to_ser = [](Data data, std::size_t offset, std::size_t size, void* to) {
    std::memcpy(to, message_of(data).bytes.data() + offset, size);
  };
  ops.to_ser_ref = lend_bytes;
  ops.to_ser_unref = [](ddsi_serdata* data, const ddsrt_iovec_t*) { ddsi_serdata_unref(data); };
  ops.to_sample = [](Data, void*, void**, void*) { return true; };
  ops.to_untyped = to_untyped;
  ops.untyped_to_sample = [](Type, Data, void*, void**, void*) { return true; };
  ops.free = [](ddsi_serdata* data) { delete static_cast<Message*>(data); };
  ops.print = [](Type, Data, char* to, std::size_t size) { return size > 0 ? (*to = '\0', size_t{0}) : 0; };
  ops.get_keyhash = [](Data, ddsi_keyhash* to, bool) { *to = {}; };
  return ops;
}

ddsi_sertype_ops type_functions() {
  using Type = const ddsi_sertype*;
  ddsi_sertype_ops ops{};
  ops.version = ddsi_sertype_v0;
  ops.free = [](ddsi_sertype* type) {
    ddsi_sertype_fini(type);
    delete type;
  };
  ops.zero_samples = [](Type, void*, std::size_t) {};
  // No samples are made, because messages are taken as they are.
  ops.realloc_samples = [](void** samples, Type, void*, std::size_t, std::size_t count) {
    std::fill_n(samples, count, nullptr);
  };
  ops.free_samples = [](Type, void**, std::size_t, dds_free_op_t) {};
  ops.equal = [](Type, Type) { return true; };  // types of one name are the same type
  ops.hash = [](Type) { return uint32_t{0}; };
  return ops;
}

ddsi_tran_write_fn_t send_packet = nullptr;  // Cyclone's function that sends a packet

/// Sends a packet. Sets the flag of parameters in the header of each message that begins with them, at the
/// end of the piece before, because Cyclone has no parameters of this kind.
ssize_t send_with_parameters(ddsi_tran_conn_t at, const ddsi_locator_t* to, std::size_t count,
                             const ddsrt_iovec_t* pieces, uint32_t flags) {
  constexpr unsigned char kData = 0x15;  // kind of a message in RTPS
  for (std::size_t i = 1; i < count; ++i) {
    const std::string_view mark = kCallMarks[0];
    const bool has_parameters =
        pieces[i].iov_len > mark.size() && std::memcmp(pieces[i].iov_base, mark.data(), mark.size()) == 0;
    if (!has_parameters || pieces[i - 1].iov_len < kDataHeader) continue;
    unsigned char* header =
        static_cast<unsigned char*>(pieces[i - 1].iov_base) + pieces[i - 1].iov_len - kDataHeader;
    if (header[0] == kData) header[1] |= kHasParameters;
  }
  return send_packet(at, to, count, pieces, flags);
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

void let_messages_have_calls(const ddsi_sertype& type) {
  const auto* domain = static_cast<const ddsi_domaingv*>(ddsrt_atomic_ldvoidp(&type.gv));
  for (int i = 0; i < domain->n_interfaces; ++i) {
    ddsi_tran_write_fn_t& send = domain->xmit_conns[i]->m_write_fn;
    if (send == send_with_parameters) continue;
    send_packet = send;
    send = send_with_parameters;
  }
}

std::string_view bytes_of(const ddsi_serdata& message) {
  const Message& own = message_of(&message);
  return std::string_view(own.bytes).substr(own.parameters, own.size - own.parameters);
}

std::string_view call_of(const ddsi_serdata& message) { return message_of(&message).call; }

}  // namespace chicane::ros
