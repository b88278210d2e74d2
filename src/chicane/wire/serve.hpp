// SPDX-License-Identifier: MIT
// Server for the original simulator: answers its telemetry with commands of our controller.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/net/server.hpp"
#include "chicane/protocol/foxglove_codec.hpp"
#include "chicane/protocol/ros_messages.hpp"
#include "chicane/protocol/udacity_codec.hpp"
#include "chicane/run/external_drive.hpp"
#include "chicane/telemetry/metrics.hpp"
#include "chicane/wire/endpoint.hpp"

namespace chicane::wire {

/// Options of the server for simulators. The default deadline of a control step is 50 ms.
struct ServeOptions : run::ExternalDriveOptions {
  ServeOptions() { step_budget = std::chrono::milliseconds{50}; }

  net::ServerOptions server;
  std::string time_field{};  ///< telemetry field with the simulator's time [s]; empty: none
  /// Artificial delay between the end of a control step and its answer, [0, 0.5 s]. The default is that of
  /// the original controller, which sleeps.
  std::chrono::nanoseconds latency = std::chrono::milliseconds{100};
  /// Silence of a client after which it gets the Engine.IO open packet. Stock clients wait for that packet.
  /// The original simulator speaks first, and would run two loops if it got the packet. This default and the
  /// next two are chosen.
  std::chrono::nanoseconds open_after = std::chrono::seconds{1};
  std::chrono::nanoseconds quiet_after = std::chrono::seconds{1};   ///< silence after which another may drive
  std::chrono::nanoseconds silent_after = std::chrono::seconds{3};  ///< silence that is reported
};

/// Callbacks of the server; the inherited ones are called on the control thread.
struct ServeHooks : run::ExternalDriveHooks {
  std::function<void(std::string_view)> log{};  ///< gets lines about the connection, on the network thread
  std::function<void(std::uint16_t port)> on_listening{};  ///< called once, when the port is bound
  std::function<void()> on_end{};  ///< called once, after control has ended and before the server ends
  Pages pages{};                   ///< answers to GET in addition to the assets
  /// Settings by name, as viewers see them. Used on the network thread; outlives the endpoint; null: none.
  protocol::foxglove::ParameterStore* parameters = nullptr;
  const protocol::Run* description = nullptr;  ///< description of the run; outlives the endpoint; null: none
};

/// Counts of the server so far.
struct ServeSummary {
  std::uint64_t answers = 0;        ///< answers to telemetry, broken ones included
  std::uint64_t manual = 0;         ///< answers while a person drove
  std::uint64_t unusable = 0;       ///< telemetry that was broken or of another scene
  std::uint64_t connections = 0;    ///< simulators that were accepted
  std::uint64_t refusals = 0;       ///< simulators refused because another one drove
  std::uint64_t interventions = 0;  ///< commands that the gate had to change
  double delay = 0.0;               ///< last measured delay, telemetry to actuation [s]
  telemetry::RunSummary run{};      ///< summary over all connections; empty until control has ended
};

/// Server in place of the original controller program: answers each telemetry of one simulator with exactly
/// one complete, finite command, and sends nothing else (docs/protocol.md). The control thread owns the
/// controller; the network thread reads, queues and sends.
///
/// Broken telemetry and telemetry of other scenes counts as a cycle without a measurement, and is answered as
/// well. The controller is reset for each new connection, and after a silence. The account of the run
/// continues over all connections.
class UdacityEndpoint final : public Endpoint {
 public:
  /// `controller` is used on the control thread only.
  UdacityEndpoint(const ServeOptions& options, std::unique_ptr<controller::Controller> controller,
                  ServeHooks hooks);
  ~UdacityEndpoint() override;
  UdacityEndpoint(const UdacityEndpoint&) = delete;
  UdacityEndpoint& operator=(const UdacityEndpoint&) = delete;

  /// Ends the control thread. Call it before the server is destroyed.
  void stop();
  /// Summary so far, complete after stop(). Any thread.
  [[nodiscard]] ServeSummary summary() const;

  void on_start(net::Server& server) override;
  [[nodiscard]] net::UpgradeAnswer on_upgrade(const net::UpgradeRequest& request) override;
  void on_open(net::ConnectionId id) override;
  void on_message(net::ConnectionId id, std::string_view bytes, bool binary) override;
  void on_close(net::ConnectionId id, std::string_view why) override;

 private:
  using Clock = std::chrono::steady_clock;
  class Control;

  /// The simulator that is driven. Network thread only.
  struct Session {
    net::ConnectionId id = 0;         ///< 0 = none
    std::string name{};               ///< address, for the log
    bool is_stock = false;            ///< Engine.IO client that got our open packet and expects pings
    bool is_version_3 = false;        ///< EIO=3: the server connects the namespace, the client pings
    bool knows_stop_plan = false;     ///< asked in its request for a stop plan with each command
    bool has_spoken = false;          ///< has sent a message
    bool has_left = false;            ///< has sent a disconnect packet; the connection still stands
    bool has_telemetry = false;       ///< has sent telemetry
    bool is_reported_silent = false;  ///< its silence was reported
    int unanswered = 0;               ///< telemetry messages without an answer yet
    Clock::time_point last_word{};    ///< time of the last message in either direction
  };

  /// Takes a message of the simulator, and queues it for the control thread if it needs an answer.
  void hear_telemetry(std::string_view bytes);
  /// Takes a packet of Engine.IO or Socket.IO that is no event.
  void hear_packet(protocol::UdacityPacket packet);
  /// Reports a faulty message; true if its sender waits for an answer.
  [[nodiscard]] bool complain_about(const protocol::UdacityTelemetry& message);
  void send(net::ConnectionId id, std::string text);
  /// Greets an Engine.IO client that waits for the server to speak first.
  void send_open_packet(net::ConnectionId id);
  /// Pings an Engine.IO client periodically.
  void ping(net::ConnectionId id);
  /// Reports a silent simulator; repeats itself.
  void watch();
  /// Whether another simulator may drive now.
  [[nodiscard]] bool is_quiet() const;

  ServeOptions options_;
  ServeHooks hooks_;
  SparseLog log_;
  net::Server* server_ = nullptr;
  Session session_;                                ///< simulator that drives
  std::map<net::ConnectionId, Session> accepted_;  ///< sessions between on_upgrade() and on_open()
  std::atomic<std::uint64_t> connections_{0};
  std::atomic<std::uint64_t> refusals_{0};
  std::atomic<std::uint64_t> unusable_{0};
  std::unique_ptr<Control> control_;  ///< the control thread
};

/// `chicane serve`: binds the port and answers simulators until `stop`. `viewer` (may be null) and `assets`
/// share the port. kIo if the port is taken; its sentence names the remedy.
[[nodiscard]] Result<ServeSummary> serve(const ServeOptions& options,
                                         std::unique_ptr<controller::Controller> controller, ServeHooks hooks,
                                         Endpoint* viewer, std::vector<net::Asset> assets,
                                         const std::atomic<bool>& stop);

}  // namespace chicane::wire
