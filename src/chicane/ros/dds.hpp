// SPDX-License-Identifier: MIT
// DDS as this module needs it: participant, readers and writers of messages that are already encoded.
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

/// Options for finding partners in the network.
struct NetworkOptions {
  int domain = 0;                       ///< ROS_DOMAIN_ID, [0, 232]
  std::string interface = "lo";         ///< network interface by name; "auto": DDS's choice
  std::vector<std::string> peers = {};  ///< addresses of partners, for networks without multicast
};

/// Quality of service of a topic, as far as ROS 2 programs choose it.
struct Qos {
  bool is_reliable = true;          ///< lost messages are sent again; false: best effort
  bool is_transient_local = false;  ///< late readers get the last messages; false: volatile
  int depth = 10;                   ///< messages kept, [1, 1000]
};

/// Message that arrived.
struct Sample {
  std::string bytes{};       ///< CDR with its header of four bytes
  std::uint64_t writer = 0;  ///< handle of its writer
  /// Identity of a request by rmw_fastrtps, which the reply has to name, 24 bytes; empty: none was sent.
  std::string call{};
};

/// Reader or writer of another program.
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
  /// Sends the reply to a request with the Sample::call `call`; false as in write().
  virtual bool reply(std::string_view bytes, std::string_view call) = 0;
  /// Number of readers that get the messages now.
  [[nodiscard]] virtual int matched() const = 0;
};

/// Receives messages of one topic. One thread.
class Reader {
 public:
  virtual ~Reader() = default;
  /// Messages that arrived since the last call, the oldest first.
  [[nodiscard]] virtual std::vector<Sample> take() = 0;
  /// Number of writers whose messages arrive now.
  [[nodiscard]] virtual int matched() const = 0;
};

/// Member of a DDS domain, by Cyclone DDS, for messages of ROS 2 types that are already encoded. One thread,
/// but any for Writer. A process may have one participant of a domain at a time.
class Participant {
 public:
  /// Joins the domain. kIo with the remedy, for example for an unknown interface.
  [[nodiscard]] static Result<std::unique_ptr<Participant>> create(const NetworkOptions& options);

  virtual ~Participant() = default;
  /// Creates a writer; `topic` and `type` as in ROS 2: "/odom", "nav_msgs/msg/Odometry". The participant
  /// outlives it.
  [[nodiscard]] virtual Result<std::unique_ptr<Writer>> writer(const std::string& topic,
                                                               const std::string& type, const Qos& qos) = 0;
  /// Creates a reader, by the same rules.
  [[nodiscard]] virtual Result<std::unique_ptr<Reader>> reader(const std::string& topic,
                                                               const std::string& type, const Qos& qos) = 0;
  /// Waits until a reader has messages, or for `patience`.
  virtual void wait(std::chrono::nanoseconds patience) = 0;
  /// Endpoints of other programs in this domain. Allocates.
  [[nodiscard]] virtual std::vector<Endpoint> others() = 0;
  /// Announces readers and writers as those of a ROS 2 node to the partners that others() found last. Sends
  /// nothing unless something has changed.
  virtual void announce(const std::string& node) = 0;
};

/// Creates the readers and writers of a node. Leaves out topics without a name; tries no further one after
/// the first failure.
class Endpoints {
 public:
  /// `at` outlives this.
  explicit Endpoints(Participant& at) : at_{at} {}

  /// Creates a reader in `to`.
  void read(std::unique_ptr<Reader>& to, const std::string& topic, std::string_view type, Qos qos) {
    if (!topic.empty() && made_) take(to, at_.reader(topic, std::string(type), qos));
  }
  /// Creates a writer in `to`.
  void send(std::unique_ptr<Writer>& to, const std::string& topic, std::string_view type, Qos qos) {
    if (!topic.empty() && made_) take(to, at_.writer(topic, std::string(type), qos));
  }
  /// Error of the reader or writer that could not be made.
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
  Result<void> made_;  ///< first failure
};

}  // namespace chicane::ros
