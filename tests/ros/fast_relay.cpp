// SPDX-License-Identifier: MIT
// Stands between simulator and controller, each in a domain of its own, with another vendor's DDS and CDR
// (eProsima Fast DDS): each message is received, decoded, encoded anew and sent on. Loses, doubles and swaps
// messages, and shifts the simulator's clock, where asked. Tells at its end, as JSON, what passed.
//   fast_relay SIMULATOR_DOMAIN CONTROLLER_DOMAIN SECONDS [loss=0.1] [twice=0.1] [swap=0.1] [jump_s=5]
//              [jump_at_s=8] [best-effort] [reliable]
//   fast_relay node DOMAIN [iron]   is a ROS 2 node by rmw_fastrtps, of Humble or of Iron: asks the parameter
//              services of /chicane, and tells what it saw of both nodes, of /map and of /scan
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fastdds/dds/core/condition/WaitSet.hpp>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace {

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;
using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kLargest = 1'000'000;  // of a message [bytes]
constexpr int kOwnIndex = 20;                  // of our first participant; those of the others are small
std::atomic<bool> stop{false};

/// A message as its bytes, with the header of CDR.
class BytesType final : public fast::TopicDataType {
 public:
  explicit BytesType(const char* name) {
    setName(name);
    m_typeSize = kLargest;
    m_isGetKeyDefined = false;
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const auto& bytes = *static_cast<std::string*>(data);
    if (bytes.size() > payload->max_size) return false;
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = static_cast<std::uint32_t>(bytes.size());
    payload->encapsulation = CDR_LE;
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    static_cast<std::string*>(data)->assign(reinterpret_cast<const char*>(payload->data), payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<std::string*>(data)->size()); };
  }
  void* createData() override { return new std::string; }
  void deleteData(void* data) override { delete static_cast<std::string*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

struct Stamp {
  std::int32_t seconds = 0;
  std::uint32_t nanoseconds = 0;
  [[nodiscard]] std::int64_t all() const { return 1'000'000'000LL * seconds + nanoseconds; }
};

/// Decodes a message and encodes it anew, field by field, with its stamp shifted.
class Anew {
 public:
  explicit Anew(std::string bytes)
      : in_bytes_{std::move(bytes)},
        in_buffer_{in_bytes_.data(), in_bytes_.size()},
        in_{in_buffer_, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR},
        out_{out_buffer_, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR} {
    in_.read_encapsulation();
    out_.serialize_encapsulation();
  }
  Stamp stamp(int shift) {
    Stamp stamp;
    in_ >> stamp.seconds >> stamp.nanoseconds;
    out_ << stamp.seconds + shift << stamp.nanoseconds;
    return stamp;
  }
  template <class Value>
  Anew& pass() {
    Value value{};
    in_ >> value;
    out_ << value;
    return *this;
  }
  [[nodiscard]] std::string bytes() { return {out_buffer_.getBuffer(), out_.getSerializedDataLength()}; }

 private:
  std::string in_bytes_;
  FastBuffer in_buffer_;
  Cdr in_;
  std::vector<char> memory_ = std::vector<char>(kLargest);
  FastBuffer out_buffer_{memory_.data(), memory_.size()};
  Cdr out_;
};

struct Passed {
  std::string bytes;
  Stamp stamp;
};
Passed odometry_anew(const std::string& bytes, int shift) {
  Anew anew(bytes);
  const Stamp stamp = anew.stamp(shift);
  anew.pass<std::string>().pass<std::string>();
  anew.pass<std::array<double, 7>>().pass<std::array<double, 36>>();  // pose
  anew.pass<std::array<double, 6>>().pass<std::array<double, 36>>();  // twist
  return {anew.bytes(), stamp};
}
Passed drive_anew(const std::string& bytes, int shift) {
  Anew anew(bytes);
  const Stamp stamp = anew.stamp(shift);
  anew.pass<std::string>().pass<std::array<float, 5>>();
  return {anew.bytes(), stamp};
}
Passed stop_anew(const std::string& bytes, int shift) {
  Anew anew(bytes);
  const Stamp stamp = anew.stamp(shift);
  for (int i = 0; i < 5; ++i) anew.pass<std::vector<double>>();
  return {anew.bytes(), stamp};
}

/// Our end in one domain, on loopback without multicast.
class Side {
 public:
  Side(int domain, int index) {
    fast::DomainParticipantQos qos;
    auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList.emplace_back("127.0.0.1");
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(udp);
    const auto at = [domain](int participant) {
      rtps::Locator_t locator;
      eprosima::fastrtps::rtps::IPLocator::setIPv4(locator, 127, 0, 0, 1);
      locator.port = static_cast<std::uint32_t>(7400 + 250 * domain + 10 + 2 * participant);
      return locator;
    };
    qos.wire_protocol().participant_id = index;
    qos.wire_protocol().builtin.metatrafficUnicastLocatorList.push_back(at(index));
    for (int i = 0; i < 4; ++i) qos.wire_protocol().builtin.initialPeersList.push_back(at(i));
    participant_ = fast::DomainParticipantFactory::get_instance()->create_participant(
        static_cast<fast::DomainId_t>(domain), qos);
    if (participant_ == nullptr) std::exit(3);
    publisher_ = participant_->create_publisher(fast::PUBLISHER_QOS_DEFAULT);
    subscriber_ = participant_->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
  }
  fast::DataReader* reader(const char* topic, const char* type, bool is_reliable, bool is_late = false) {
    fast::DataReaderQos qos = fast::DATAREADER_QOS_DEFAULT;
    if (is_late) qos.durability().kind = fast::TRANSIENT_LOCAL_DURABILITY_QOS;
    qos.reliability().kind = is_reliable ? fast::RELIABLE_RELIABILITY_QOS : fast::BEST_EFFORT_RELIABILITY_QOS;
    qos.history().depth = 10;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    return subscriber_->create_datareader(this->topic(topic, type), qos);
  }
  fast::DataWriter* writer(const char* topic, const char* type, bool is_reliable,
                           const std::string& user_data = {}) {
    fast::DataWriterQos qos = fast::DATAWRITER_QOS_DEFAULT;
    qos.user_data().data_vec({user_data.begin(), user_data.end()});
    qos.reliability().kind = is_reliable ? fast::RELIABLE_RELIABILITY_QOS : fast::BEST_EFFORT_RELIABILITY_QOS;
    qos.history().depth = 10;
    qos.publish_mode().kind = fast::SYNCHRONOUS_PUBLISH_MODE;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    return publisher_->create_datawriter(this->topic(topic, type), qos);
  }

 private:
  fast::Topic* topic(const char* topic, const char* type) {
    if (auto* known = dynamic_cast<fast::Topic*>(participant_->lookup_topicdescription(topic))) return known;
    fast::TypeSupport(new BytesType(type)).register_type(participant_);
    return participant_->create_topic(topic, type, fast::TOPIC_QOS_DEFAULT);
  }
  fast::DomainParticipant* participant_ = nullptr;
  fast::Publisher* publisher_ = nullptr;
  fast::Subscriber* subscriber_ = nullptr;
};

std::vector<std::string> take(fast::DataReader* reader) {
  std::vector<std::string> taken;
  std::string bytes;
  fast::SampleInfo info;
  while (reader->take_next_sample(&bytes, &info) == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK)
    if (info.valid_data) taken.push_back(bytes);
  return taken;
}

/// A message's way through a bad network.
class Road {
 public:
  Road(fast::DataWriter* to, double loss, double twice, double swap)
      : to_{to}, loss_{loss}, twice_{twice}, swap_{swap} {}
  void send(std::string bytes) {
    if (is_so(loss_)) return;
    const bool is_twice = is_so(twice_);
    if (held_.empty() && is_so(swap_)) {
      held_ = std::move(bytes);
      return;
    }
    to_->write(&bytes);
    if (is_twice) to_->write(&bytes);
    if (!held_.empty()) to_->write(&held_);
    held_.clear();
  }

 private:
  bool is_so(double share) { return share > 0.0 && std::uniform_real_distribution<>()(random_) < share; }
  fast::DataWriter* to_;
  double loss_, twice_, swap_;
  std::string held_{};
  std::mt19937 random_{1};
};

/// A request in CDR.
template <class... Values>
std::string encoded(const Values&... values) {
  std::vector<char> memory(kLargest);
  FastBuffer buffer(memory.data(), memory.size());
  Cdr to(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
  to.serialize_encapsulation();
  (to << ... << values);
  return {buffer.getBuffer(), to.getSerializedDataLength()};
}

/// The first values of a message.
template <class... Values>
void decode(std::string bytes, Values&... values) {
  FastBuffer buffer(bytes.data(), bytes.size());
  Cdr from(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
  from.read_encapsulation();
  (from >> ... >> values);
}

/// Asks a service of /chicane as rmw_fastrtps does, and waits for the reply that names the request.
std::string ask(Side& side, const std::string& service, const std::string& type, std::string request) {
  const std::string full = "rcl_interfaces::srv::dds_::" + type;
  fast::DataWriter* requests =
      side.writer(("rq/chicane/" + service + "Request").c_str(), (full + "_Request_").c_str(), true);
  fast::DataReader* replies =
      side.reader(("rr/chicane/" + service + "Reply").c_str(), (full + "_Response_").c_str(), true);
  fast::PublicationMatchedStatus asked;
  fast::SubscriptionMatchedStatus heard;
  for (int i = 0; i < 500 && (asked.current_count == 0 || heard.current_count == 0); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
    requests->get_publication_matched_status(asked);
    replies->get_subscription_matched_status(heard);
  }
  rtps::WriteParams call;
  call.related_sample_identity().writer_guid(replies->guid());
  requests->write(&request, call);
  std::string bytes;
  fast::SampleInfo info;
  while (replies->wait_for_unread_message(eprosima::fastrtps::Duration_t(5, 0))) {
    replies->take_next_sample(&bytes, &info);
    if (info.related_sample_identity.writer_guid() == replies->guid() &&
        info.related_sample_identity.sequence_number() == call.sample_identity().sequence_number())
      return bytes;
  }
  return {};
}

/// Prints what a node of rmw_fastrtps sees of ours.
int be_a_node(int domain, bool is_iron) {
  using Names = std::vector<std::string>;
  constexpr const char* kInfo = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";
  Side side(domain, kOwnIndex);
  static_cast<void>(side.writer("ros_discovery_info", kInfo, true, is_iron ? "typehash=RIHS01_0;" : ""));
  fast::DataReader* nodes = side.reader("ros_discovery_info", kInfo, true, true);
  fast::DataReader* map = side.reader("rt/map", "nav_msgs::msg::dds_::OccupancyGrid_", true, true);
  fast::DataReader* scan = side.reader("rt/scan", "sensor_msgs::msg::dds_::LaserScan_", false);
  const std::string key = "tracking_mpc.weight_lateral";
  Names listed;
  decode(ask(side, "list_parameters", "ListParameters", encoded(Names{}, std::uint64_t{0})), listed);
  std::vector<std::uint8_t> types;
  decode(ask(side, "get_parameter_types", "GetParameterTypes", encoded(Names{key})), types);
  const std::uint32_t one = 1, none = 0;
  const auto setting = encoded(one, key, std::uint8_t{3}, false, std::int64_t{0}, 2.0, std::string(), none,
                               none, none, none, none);
  std::uint32_t count = 0;
  bool is_set = false, are_set = true, flag = false;
  decode(ask(side, "set_parameters", "SetParameters", setting), count, is_set);
  decode(ask(side, "set_parameters_atomically", "SetParametersAtomically", setting), are_set);
  std::uint8_t type = 0;
  std::int64_t integer = 0;
  double value = 0.0;
  decode(ask(side, "get_parameters", "GetParameters", encoded(Names{key})), count, type, flag, integer,
         value);
  const std::size_t described =
      ask(side, "describe_parameters", "DescribeParameters", encoded(listed)).size();
  std::set<std::string> seen;
  std::size_t maps = 0, scans = 0;
  for (int i = 0; i < 200 && (seen.size() < 2 || maps == 0 || scans == 0); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds{50});
    for (std::string bytes : take(nodes)) {
      bytes.erase(4, is_iron ? 16 : 24);  // the GUID of the participant
      std::string space, name;
      decode(bytes, count, space, name);
      if (space == "/") seen.insert("\"" + space + name + "\"");  // else in the other release's layout
    }
    maps += take(map).size();
    scans += take(scan).size();
  }
  std::string names;
  for (const std::string& name : seen) names += (names.empty() ? "" : ", ") + name;
  std::printf(
      "{\"listed\": %zu, \"type\": %d, \"set\": %d, \"set_atomically\": %d, \"value\": %g, "
      "\"described_bytes\": %zu, \"nodes\": [%s], \"maps\": %zu, \"scans\": %zu}\n",
      listed.size(), types.empty() ? -1 : types[0], is_set, are_set, value, described, names.c_str(), maps,
      scans);
  std::fflush(stdout);
  std::_Exit(0);
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return -1.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace

int main(int count, char** words) {
  if (count >= 3 && std::string(words[1]) == "node") return be_a_node(std::atoi(words[2]), count > 3);
  if (count < 4) return 2;
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { stop = true; });
  std::map<std::string, double> told;
  for (int i = 4; i < count; ++i) {
    const std::string word = words[i];
    const std::size_t end = word.find('=');
    told[word.substr(0, end)] = end == std::string::npos ? 1.0 : std::atof(word.c_str() + end + 1);
  }
  Side simulator(std::atoi(words[1]), kOwnIndex), controller(std::atoi(words[2]), kOwnIndex + 1);
  const char* odometry_type = "nav_msgs::msg::dds_::Odometry_";
  const char* drive_type = "ackermann_msgs::msg::dds_::AckermannDriveStamped_";
  const char* stop_type = "chicane_msgs::msg::dds_::StopPlan_";
  fast::DataReader* odometry = simulator.reader("rt/ego_racecar/odom", odometry_type, true);
  fast::DataReader* drive = controller.reader("rt/drive", drive_type, true);
  fast::DataReader* stops = controller.reader("rt/chicane/stop_plan", stop_type, true);
  const bool is_reliable = told.count("best-effort") == 0;
  Road forth(controller.writer("rt/ego_racecar/odom", odometry_type, is_reliable), told["loss"],
             told["twice"], told["swap"]);
  Road back(simulator.writer("rt/drive", drive_type, is_reliable), told["loss"], told["twice"], told["swap"]);
  Road back_stops(simulator.writer("rt/chicane/stop_plan", stop_type, is_reliable), told["loss"],
                  told["twice"], 0.0);

  fast::WaitSet waiting;
  for (fast::DataReader* reader : {odometry, drive, stops}) {
    reader->get_statuscondition().set_enabled_statuses(fast::StatusMask::data_available());
    waiting.attach_condition(reader->get_statuscondition());
  }
  const Clock::time_point began = Clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - began).count(); };
  struct Sent {
    double time = 0.0;  // [s]
    int shift = 0;      // of its stamp [s]
  };
  std::map<std::int64_t, Sent> sent;  // odometry by its stamp, as it was sent on
  std::vector<double> answers;        // from odometry to command [ms]
  std::uint64_t different = 0, commands = 0;
  double first = -1.0;
  while (!stop && seconds() < std::atof(words[3])) {
    fast::ConditionSeq triggered;
    waiting.wait(triggered, eprosima::fastrtps::Duration_t(0, 20'000'000));
    for (const std::string& bytes : take(odometry)) {
      if (first < 0.0) first = seconds();
      const bool has_jumped = told["jump_s"] != 0.0 && commands > 0 && seconds() - first > told["jump_at_s"];
      const int shift = has_jumped ? static_cast<int>(told["jump_s"]) : 0;
      const Passed passed = odometry_anew(bytes, shift);
      different += shift == 0 && passed.bytes != bytes ? 1U : 0U;
      sent[passed.stamp.all() + 1'000'000'000LL * shift] = {seconds(), shift};
      forth.send(passed.bytes);
    }
    const std::vector<std::string> drives = take(drive);
    // A command has the stamp of the odometry that it answers, or one soon after it: the same shift back.
    const auto shift_back = [&](std::int64_t stamp) {
      const auto next = sent.upper_bound(stamp);
      return next == sent.begin() ? 0 : -std::prev(next)->second.shift;
    };
    const auto stamp_of = [](const std::string& bytes) {
      Anew anew(bytes);
      return anew.stamp(0).all();
    };
    for (const std::string& bytes : take(stops))
      back_stops.send(stop_anew(bytes, shift_back(stamp_of(bytes))).bytes);
    for (const std::string& bytes : drives) {
      const std::int64_t stamp = stamp_of(bytes);
      const Passed passed = drive_anew(bytes, shift_back(stamp));
      ++commands;
      different += shift_back(stamp) == 0 && passed.bytes != bytes ? 1U : 0U;
      if (const auto asked = sent.find(stamp); asked != sent.end())
        answers.push_back(1e3 * (seconds() - asked->second.time));
      back.send(passed.bytes);
    }
    while (sent.size() > 2000) sent.erase(sent.begin());
  }
  std::printf(
      "{\"commands\": %llu, \"answered\": %zu, \"different\": %llu, \"p50_ms\": %.3f, \"p999_ms\": %.3f}\n",
      static_cast<unsigned long long>(commands), answers.size(), static_cast<unsigned long long>(different),
      quantile(answers, 0.5), quantile(answers, 0.999));
  std::fflush(stdout);
  std::_Exit(0);
}
