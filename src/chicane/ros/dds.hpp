// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chicane/base/result.hpp"

namespace chicane::ros {

/// Options for finding partners.
struct NetworkOptions {
  int domain = 0;                       ///< ROS_DOMAIN_ID, [0, 232]
  std::string interface = "lo";         ///< network interface by name; "auto": DDS's choice
  std::vector<std::string> peers = {};  ///< addresses that are asked one by one, where there is no multicast
};

/// Quality of service of one topic, the part that ROS 2 programs choose.
struct Qos {
  bool is_reliable = true;          ///< lost messages are sent again; false: best effort
  bool is_transient_local = false;  ///< late readers get the last messages; false: volatile
  int depth = 10;                   ///< messages kept, [1, 1000]
};

/// One message that arrived, its bytes as in RosTopic: CDR with its four-byte header.
struct Sample {
  std::string bytes{};
  std::uint64_t writer = 0;  ///< handle of the writer: another number is another writer
  /// Of a request that rmw_fastrtps sends: what the reply has to name, 24 bytes; empty: sent without.
  std::string call{};
};

/// A reader or writer that another program has.
struct Endpoint {
  bool is_writer = false;
  std::string topic{};  ///< name in ROS 2: "/odom"
  std::string type{};   ///< name in ROS 2: "nav_msgs/msg/Odometry"
  Qos qos{};
};

/// Sends messages of one topic. Any thread.
class Writer {
 public:
  virtual ~Writer() = default;
  /// Sends `bytes` (CDR with header). False when DDS refuses, as when a reliable reader does not keep up.
  bool write(std::string_view bytes) { return reply(bytes, {}); }
  /// Sends the reply to a request, whose Sample::call is `call`.
  virtual bool reply(std::string_view bytes, std::string_view call) = 0;
  /// Readers that get the messages now.
  [[nodiscard]] virtual int matched() const = 0;
};

/// Receives messages of one topic. One thread.
class Reader {
 public:
  virtual ~Reader() = default;
  /// The messages that arrived since the last call, oldest first.
  [[nodiscard]] virtual std::vector<Sample> take() = 0;
  /// Writers whose messages arrive now.
  [[nodiscard]] virtual int matched() const = 0;
};

/// One program in a DDS domain, by Cyclone DDS. Messages are of ROS 2 types and go as they are encoded. One
/// thread, but for Writer. One object for a domain and process at a time.
class Participant {
 public:
  /// Joins the domain. kIo with the remedy, for example for an unknown interface.
  [[nodiscard]] static Result<std::unique_ptr<Participant>> create(const NetworkOptions& options);

  virtual ~Participant() = default;
  /// `topic` and `type` as in ROS 2: "/odom", "nav_msgs/msg/Odometry". Gone before the participant.
  [[nodiscard]] virtual Result<std::unique_ptr<Writer>> writer(const std::string& topic,
                                                               const std::string& type, const Qos& qos) = 0;
  [[nodiscard]] virtual Result<std::unique_ptr<Reader>> reader(const std::string& topic,
                                                               const std::string& type, const Qos& qos) = 0;
  /// Comes back when a reader has messages, or after `patience`.
  virtual void wait(std::chrono::nanoseconds patience) = 0;
  /// Endpoints of other programs in this domain. Allocates.
  [[nodiscard]] virtual std::vector<Endpoint> others() = 0;
  /// Announces readers and writers as those of a ROS 2 node, to the partners that others() found last. Sends
  /// nothing where nothing changed.
  virtual void announce(const std::string& node) = 0;
};

/// Readers and writers of a node, one after the other: a topic without a name is left out, and after the
/// first that cannot be made no other is tried.
class Endpoints {
 public:
  /// `at` has to outlive it.
  explicit Endpoints(Participant& at) : at_{at} {}

  void read(std::unique_ptr<Reader>& to, const std::string& topic, std::string_view type, Qos qos) {
    if (!topic.empty() && made_) take(to, at_.reader(topic, std::string(type), qos));
  }
  void send(std::unique_ptr<Writer>& to, const std::string& topic, std::string_view type, Qos qos) {
    if (!topic.empty() && made_) take(to, at_.writer(topic, std::string(type), qos));
  }
  /// Error of the object that could not be made.
  [[nodiscard]] const Result<void>& made() const noexcept { return made_; }

 private:
  template <class Endpoint>
  void take(std::unique_ptr<Endpoint>& to, Result<std::unique_ptr<Endpoint>> endpoint) {
    if (endpoint)
      to = std::move(*endpoint);
    else
      made_ = fail(endpoint.error());
  }

  Participant& at_;
  Result<void> made_;
};

}  // namespace chicane::ros
