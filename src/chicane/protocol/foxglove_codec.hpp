// SPDX-License-Identifier: MIT
// Server side of the Foxglove WebSocket protocol: structs of its messages, and their bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/telemetry/metrics.hpp"

/// Version 1 of the protocol (github.com/foxglove/ws-protocol, docs/spec.md), as pure functions between
/// structs and bytes. Both of its sub-protocol names have the same bytes. The caller stores the subscriptions
/// (wire/viewer.hpp).
namespace chicane::protocol::foxglove {

using ParameterValue = std::variant<std::monostate, bool, double, std::string, std::vector<double>>;

/// Named value that viewers may read and set. monostate: not set.
struct Parameter {
  std::string name;  ///< "tracking_mpc.horizon_steps"
  ParameterValue value;
};

/// Storage of a run's settings; implemented by the owner of the run. Called on the network thread.
class ParameterStore {
 public:
  virtual ~ParameterStore() = default;
  [[nodiscard]] virtual std::vector<Parameter> list() const = 0;
  [[nodiscard]] virtual std::optional<Parameter> get(std::string_view name) const = 0;
  /// Fails with a sentence for the operator ("tracking_mpc.step_length_s: got 3, expected 0.01 to 0.2").
  [[nodiscard]] virtual Result<void> set(const Parameter& parameter) = 0;
  /// Continues work under way, such as building another run. Called at each tick of the viewers.
  virtual void update() {}
  /// Settings that any client or the program itself changed since the last call.
  [[nodiscard]] virtual std::vector<Parameter> news() { return {}; }
  /// Sentences for all operators about changes that were accepted and have failed since the last call.
  [[nodiscard]] virtual std::vector<std::string> complaints() { return {}; }
  /// Changes that the run has applied since the last call.
  [[nodiscard]] virtual std::vector<telemetry::Change> applied() { return {}; }
};

// ---- messages of clients, by their names in the protocol ----

/// Subscription of a client to a channel.
struct Subscription {
  std::uint32_t id = 0;       ///< chosen by the client
  std::uint32_t channel = 0;  ///< Channel::id
};
struct Subscribe {
  std::vector<Subscription> subscriptions;
};
struct Unsubscribe {
  std::vector<std::uint32_t> ids;
};
struct GetParameters {
  std::vector<std::string> names;      ///< empty: all
  std::optional<std::string> request;  ///< id that the answer repeats
};
struct SetParameters {
  std::vector<Parameter> parameters;
  std::optional<std::string> request;  ///< id that the answer repeats
};
struct SubscribeParameters {
  std::vector<std::string> names;  ///< empty: all
};
struct UnsubscribeParameters {
  std::vector<std::string> names;  ///< empty: all
};
struct CallService {
  std::uint32_t service = 0;  ///< Service::id
  std::uint32_t call = 0;     ///< chosen by the client
  std::string encoding;       ///< "cdr"
  std::string payload;        ///< request in that encoding
};

/// Amount that a reader has read so far, by which the server paces its messages (wire/viewer.hpp). Our
/// addition to the protocol.
struct Received {
  std::uint64_t bytes = 0;  ///< binary messages since the connection began [byte]
  double at = 0.0;          ///< time by the reader's clock, echoed to it: any finite number
};

using ClientMessage = std::variant<Subscribe, Unsubscribe, GetParameters, SetParameters, SubscribeParameters,
                                   UnsubscribeParameters, CallService, Received>;

/// Limit of the entries of a list in a message; chosen: bounds memory.
inline constexpr std::size_t kMaxEntries = 1024;

/// Reads one message of a client. kParse with a sentence for the client for anything malformed, unknown or
/// too long; text that is not JSON or not UTF-8, wrong types, numbers outside uint32, lists longer than
/// kMaxEntries are all refused.
[[nodiscard]] Result<ClientMessage> parse(std::string_view bytes, bool binary);

// ---- messages of the server ----

/// Stream that clients can subscribe to; its encoding is "cdr", that of its schema "ros2msg".
struct Channel {
  std::uint32_t id = 0;
  std::string_view topic;   ///< "/odom"
  std::string_view type;    ///< "nav_msgs/msg/Odometry"
  std::string_view schema;  ///< definition of the type
};

/// Procedure that clients can call, with ROS 2 request and response in CDR.
struct Service {
  std::uint32_t id = 0;
  std::string_view name;
  std::string_view type;             ///< "std_srvs/srv/Trigger"
  std::string_view request_schema;   ///< .msg text, may be empty
  std::string_view response_schema;  ///< .msg text
};

enum class StatusLevel { kInfo = 0, kWarning = 1, kError = 2 };

/// Features of a server in addition to sending messages.
struct Capabilities {
  bool parameters = false;
  bool services = false;
};

/// Greeting of a connection. `session` changes when a new run begins: viewers then drop their drawings.
[[nodiscard]] std::string server_info(std::string_view name, std::string_view session, Capabilities can);
[[nodiscard]] std::string advertise(std::span<const Channel> channels);
[[nodiscard]] std::string advertise_services(std::span<const Service> services);
[[nodiscard]] std::string status(StatusLevel level, std::string_view message);
/// Answer to Received: its `at`, and the time [s] from its arrival to this answer. The next frame follows.
[[nodiscard]] std::string heard(double at, double held);
/// Number of messages of the past that the server has yet to send on "/chicane/past".
[[nodiscard]] std::string past_left(std::size_t messages);
[[nodiscard]] std::string parameter_values(std::span<const Parameter> parameters,
                                           const std::optional<std::string>& request = {});
[[nodiscard]] std::string service_failure(const CallService& call, std::string_view message);

// Binary messages. Times are in nanoseconds.
[[nodiscard]] std::string message_data(std::uint32_t subscription, std::uint64_t time,
                                       std::string_view payload);
[[nodiscard]] std::string time_message(std::uint64_t time);
[[nodiscard]] std::string service_response(const CallService& call, std::string_view payload);

}  // namespace chicane::protocol::foxglove
