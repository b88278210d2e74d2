// SPDX-License-Identifier: MIT
// DDS by Cyclone DDS: participant, readers and writers. Only this file and cdr_type.cpp include Cyclone.
#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsrt/log.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <utility>

#include "chicane/protocol/car_messages.hpp"
#include "chicane/ros/cdr_type.hpp"
#include "chicane/ros/dds.hpp"

namespace chicane::ros {
namespace {

constexpr std::size_t kCdrHeader = 4;                   // [byte] header of a message in CDR
constexpr uint32_t kTakenAtOnce = 64;                   // messages taken in a call of Cyclone; chosen
constexpr dds_duration_t kWriteTimeout = DDS_MSECS(2);  // chosen: a control step cannot wait longer
// Topic by which ROS 2 nodes announce endpoints.
constexpr std::string_view kDiscovery = "ros_discovery_info";
// User data of our writers of that topic, which fit any release.
constexpr std::string_view kOurs = "chicane";
// Lengths of a GUID in that topic: up to ROS 2 Humble, and since Iron, whose endpoints have a hash of their
// type.
constexpr std::size_t kHumbleGuid = 24, kIronGuid = 16;  // [byte]

/// Entity of Cyclone DDS, deleted with its owner.
class Entity {
 public:
  explicit Entity(dds_entity_t handle = 0) : handle_{handle} {}
  ~Entity() {
    if (handle_ > 0) dds_delete(handle_);
  }
  Entity(Entity&& other) noexcept : handle_{std::exchange(other.handle_, 0)} {}
  Entity& operator=(Entity&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  [[nodiscard]] dds_entity_t get() const { return handle_; }

 private:
  dds_entity_t handle_;
};

using QosHandle = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

QosHandle cyclone_qos(const Qos& qos) {
  QosHandle to(dds_create_qos(), dds_delete_qos);
  dds_qset_reliability(to.get(), qos.is_reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       kWriteTimeout);
  dds_qset_durability(to.get(),
                      qos.is_transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(to.get(), DDS_HISTORY_KEEP_LAST, qos.depth);
  if (qos.is_transient_local) {
    dds_qset_durability_service(to.get(), 0, DDS_HISTORY_KEEP_LAST, qos.depth, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  }
  return to;
}

Qos qos_of(const dds_qos_t* from) {
  Qos qos;
  dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
  dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
  dds_qget_reliability(from, &reliability, nullptr);
  dds_qget_durability(from, &durability);
  qos.is_reliable = reliability == DDS_RELIABILITY_RELIABLE;
  qos.is_transient_local = durability != DDS_DURABILITY_VOLATILE;
  return qos;
}

std::string user_data_of(const dds_qos_t* from) {
  void* data = nullptr;
  std::size_t size = 0;
  if (!dds_qget_userdata(from, &data, &size) || data == nullptr) return {};
  const std::string text(static_cast<const char*>(data), size);
  dds_free(data);
  return text;
}

/// Text for XML: all characters but plain ones as their numbers.
std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          std::string_view("._:-%").find(c) != std::string_view::npos;
    safe +=
        is_plain ? std::string(1, c) : fmt::format("&#{};", static_cast<int>(static_cast<unsigned char>(c)));
  }
  return safe;
}

/// Settings of Cyclone in XML: the interface, and the peers if there is no multicast.
std::string configuration(const NetworkOptions& options) {
  const bool is_loopback = options.interface == "lo";
  std::string peers = is_loopback ? R"(<Peer Address="127.0.0.1"/>)" : "";
  for (const std::string& peer : options.peers)
    peers += fmt::format(R"(<Peer Address="{}"/>)", escaped(peer));
  const std::string interface = options.interface == "auto" ? R"(<NetworkInterface autodetermine="true"/>)"
                                                            : fmt::format(R"(<NetworkInterface name="{}"/>)",
                                                                          escaped(options.interface));
  const bool has_multicast = !is_loopback && options.peers.empty();
  return fmt::format(
      "<CycloneDDS><Domain id=\"any\"><General><Interfaces>{}</Interfaces><AllowMulticast>{}</AllowMulticast>"
      "<MaxMessageSize>65000B</MaxMessageSize><FragmentSize>60000B</FragmentSize></"
      "General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
      "<MaxAutoParticipantIndex>60</MaxAutoParticipantIndex><LeaseDuration>4s</LeaseDuration>{}</Discovery>"
      "<Tracing><Verbosity>none</Verbosity></Tracing></Domain></CycloneDDS>",
      interface, has_multicast ? "default" : "false",
      peers.empty() ? "" : fmt::format("<Peers>{}</Peers>", peers));
}

class CycloneWriter final : public Writer {
 public:
  explicit CycloneWriter(Entity writer) : writer_{std::move(writer)} {}
  bool reply(std::string_view bytes, std::string_view call) override {
    const OutgoingMessage message{bytes, call};
    return bytes.size() >= kCdrHeader && dds_write(writer_.get(), &message) == DDS_RETCODE_OK;
  }
  [[nodiscard]] int matched() const override {
    return std::max(0, static_cast<int>(dds_get_matched_subscriptions(writer_.get(), nullptr, 0)));
  }

 private:
  Entity writer_;
};

class CycloneReader final : public Reader {
 public:
  explicit CycloneReader(Entity reader) : reader_{std::move(reader)} {}

  std::vector<Sample> take() override {
    std::vector<Sample> taken;
    std::array<ddsi_serdata*, kTakenAtOnce> messages{};
    std::array<dds_sample_info_t, kTakenAtOnce> infos{};
    for (;;) {
      const int count =
          dds_takecdr(reader_.get(), messages.data(), kTakenAtOnce, infos.data(), DDS_ANY_STATE);
      for (int i = 0; i < count; ++i) {
        ddsi_serdata* message = messages[static_cast<std::size_t>(i)];
        const dds_sample_info_t& info = infos[static_cast<std::size_t>(i)];
        if (info.valid_data) {
          taken.push_back({.bytes = std::string(bytes_of(*message)),
                           .writer = info.publication_handle,
                           .call = std::string(call_of(*message))});
        }
        ddsi_serdata_unref(message);
      }
      if (count < static_cast<int>(kTakenAtOnce)) return taken;
    }
  }
  [[nodiscard]] int matched() const override {
    return std::max(0, static_cast<int>(dds_get_matched_publications(reader_.get(), nullptr, 0)));
  }

 private:
  Entity reader_;
};

class CycloneParticipant final : public Participant {
 public:
  CycloneParticipant(Entity domain, Entity participant)
      : domain_{std::move(domain)}, participant_{std::move(participant)} {
    dds_get_guid(participant_.get(), &own_);
    waitset_ = Entity(dds_create_waitset(participant_.get()));
    publications_ =
        Entity(dds_create_reader(participant_.get(), DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr));
    subscriptions_ =
        Entity(dds_create_reader(participant_.get(), DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, nullptr, nullptr));
  }

  Result<std::unique_ptr<Writer>> writer(const std::string& topic, const std::string& type,
                                         const Qos& qos) override {
    const auto handle = topic_of(topic, type);
    if (!handle) return fail(handle.error());
    const QosHandle own = cyclone_qos(qos);
    if (topic == kDiscovery) dds_qset_userdata(own.get(), kOurs.data(), kOurs.size());
    const dds_entity_t made = dds_create_writer(participant_.get(), *handle, own.get(), nullptr);
    if (made < 0)
      return fail(ErrorCode::kIo, fmt::format("DDS: writer of {}: {}", topic, dds_strretcode(-made)));
    dds_get_guid(made, &writers_.emplace_back());
    return std::unique_ptr<Writer>(std::make_unique<CycloneWriter>(Entity(made)));
  }

  Result<std::unique_ptr<Reader>> reader(const std::string& topic, const std::string& type,
                                         const Qos& qos) override {
    const auto handle = topic_of(topic, type);
    if (!handle) return fail(handle.error());
    const dds_entity_t made = dds_create_reader(participant_.get(), *handle, cyclone_qos(qos).get(), nullptr);
    if (made < 0)
      return fail(ErrorCode::kIo, fmt::format("DDS: reader of {}: {}", topic, dds_strretcode(-made)));
    dds_get_guid(made, &readers_.emplace_back());
    dds_set_status_mask(made, DDS_DATA_AVAILABLE_STATUS);
    dds_waitset_attach(waitset_.get(), made, 0);
    return std::unique_ptr<Reader>(std::make_unique<CycloneReader>(Entity(made)));
  }

  void wait(std::chrono::nanoseconds patience) override {
    dds_attach_t triggered = 0;
    dds_waitset_wait(waitset_.get(), &triggered, 1, std::max<dds_duration_t>(patience.count(), 0));
  }

  std::vector<Endpoint> others() override {
    std::vector<Endpoint> found;
    collect(publications_.get(), true, found);
    collect(subscriptions_.get(), false, found);
    return found;
  }

  void announce(const std::string& node) override {
    if (partners_guid_ == announced_guid_) return;
    announced_guid_ = partners_guid_;
    protocol::CdrWriter to;
    const auto put = [&](const dds_guid_t& guid) {
      for (std::size_t i = 0; i < announced_guid_; ++i)
        to.put(i < sizeof guid.v ? guid.v[i] : std::uint8_t{0});
    };
    put(own_);
    to.count(1).text("/").text(node);
    for (const std::vector<dds_guid_t>* guids : {&readers_, &writers_}) {
      to.count(guids->size());
      for (const dds_guid_t& guid : *guids) put(guid);
    }
    if (!announcer_) {
      auto made = writer(std::string(kDiscovery), "rmw_dds_common/msg/ParticipantEntitiesInfo",
                         {.is_transient_local = true, .depth = 1});
      if (!made) return;
      announcer_ = std::move(*made);
    }
    announcer_->write(to.bytes());
  }

 private:
  /// Adds the endpoints of other programs in a built-in topic to `found`, and notes the partners' release.
  void collect(dds_entity_t builtin, bool is_writer, std::vector<Endpoint>& found) {
    std::array<void*, 256> samples{};
    std::array<dds_sample_info_t, 256> infos{};
    const int count = dds_read_mask(builtin, samples.data(), infos.data(), samples.size(), samples.size(),
                                    DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ALIVE_INSTANCE_STATE);
    for (int i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const auto* endpoint = static_cast<const dds_builtintopic_endpoint_t*>(samples[at]);
      const bool is_own = std::memcmp(&endpoint->participant_key, &own_, sizeof own_) == 0;
      if (!infos[at].valid_data || is_own || endpoint->topic_name == nullptr) continue;
      const std::string data = user_data_of(endpoint->qos);
      if (is_writer && endpoint->topic_name == kDiscovery && data != kOurs)
        partners_guid_ = data.find("typehash=") != std::string::npos ? kIronGuid : kHumbleGuid;
      found.push_back({.is_writer = is_writer,
                       .topic = ros_topic(endpoint->topic_name),
                       .type = ros_type(endpoint->type_name),
                       .qos = qos_of(endpoint->qos)});
    }
    if (count > 0) dds_return_loan(builtin, samples.data(), count);
  }

  /// Handle of a topic, which is made once for a name and type.
  Result<dds_entity_t> topic_of(const std::string& topic, const std::string& type) {
    const auto known = topics_.find({topic, type});
    if (known != topics_.end()) return known->second;
    ddsi_sertype* made = make_cdr_type(dds_type(type));
    const dds_entity_t handle = dds_create_topic_sertype(participant_.get(), dds_topic(topic).c_str(), &made,
                                                         nullptr, nullptr, nullptr);
    if (handle < 0) {
      ddsi_sertype_unref(made);
      return fail(ErrorCode::kIo, fmt::format("DDS: topic {}: {}", topic, dds_strretcode(-handle)));
    }
    let_messages_have_calls(*made);
    topics_[{topic, type}] = handle;
    return handle;
  }

  Entity domain_;
  Entity participant_;
  Entity waitset_, publications_, subscriptions_;  ///< waiting for messages, and readers of built-in topics
  dds_guid_t own_{};                               ///< GUID of the participant
  std::vector<dds_guid_t> readers_, writers_;      ///< GUIDs of our endpoints
  std::unique_ptr<Writer> announcer_;              ///< writer of kDiscovery; null: nothing was announced
  std::size_t partners_guid_ = 0;   ///< length of the partners' GUIDs [byte]; 0: no partner is a ROS 2 node
  std::size_t announced_guid_ = 0;  ///< length of the announced GUIDs [byte]
  std::map<std::pair<std::string, std::string>, dds_entity_t> topics_;  ///< handles by name and type
};

}  // namespace

Result<std::unique_ptr<Participant>> Participant::create(const NetworkOptions& options) {
  // Silence Cyclone's own log: our error names a refused interface, and packets of strangers could fill any
  // log.
  dds_set_log_sink([](void*, const dds_log_data_t*) {}, nullptr);
  const auto domain_id = static_cast<dds_domainid_t>(options.domain);
  Entity domain(dds_create_domain(domain_id, configuration(options).c_str()));
  const auto refused = [&](dds_entity_t code) {
    return fail(ErrorCode::kIo,
                fmt::format("DDS: domain {} cannot be entered by the network interface {}: {}; "
                            "is there an interface of this name (ip link)?",
                            options.domain, options.interface, dds_strretcode(-code)));
  };
  if (domain.get() < 0) return refused(domain.get());
  const QosHandle qos(dds_create_qos(), dds_delete_qos);
  constexpr std::string_view kEnclave = "enclave=/;";  // marks a participant of ROS 2
  dds_qset_userdata(qos.get(), kEnclave.data(), kEnclave.size());
  Entity participant(dds_create_participant(domain_id, qos.get(), nullptr));
  if (participant.get() < 0) return refused(participant.get());
  return std::unique_ptr<Participant>(
      std::make_unique<CycloneParticipant>(std::move(domain), std::move(participant)));
}

}  // namespace chicane::ros
