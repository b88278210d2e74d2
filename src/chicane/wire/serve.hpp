// SPDX-License-Identifier: MIT
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

/// How simulators are answered. The deadline of a control step is 50 ms where nothing else is said.
struct ServeOptions : run::ExternalDriveOptions {
  ServeOptions() { step_budget = std::chrono::milliseconds{50}; }

  net::ServerOptions server;
  std::string time_field{};  ///< of telemetry, that carries the simulator's time [s]; empty: none
  /// Artificial, between the end of a control step and its answer, as the original controller sleeps. [0, 0.5
  /// s]
  std::chrono::nanoseconds latency = std::chrono::milliseconds{100};
  /// A client that has said nothing for so long gets the Engine.IO open packet: stock clients wait for it,
  /// the original speaks first (and would double its loop if it got one).
  std::chrono::nanoseconds open_after = std::chrono::seconds{1};
  std::chrono::nanoseconds quiet_after = std::chrono::seconds{1};   ///< then another connection may take over
  std::chrono::nanoseconds silent_after = std::chrono::seconds{3};  ///< then missing telemetry is reported
};

/// Those of the drive are called on the control thread.
struct ServeHooks : run::ExternalDriveHooks {
  std::function<void(std::string_view)> log{};  ///< one line about the connection, on the network thread
  std::function<void(std::uint16_t port)> on_listening{};  ///< once, when the port is ours
  std::function<void()> on_end{};  ///< once: control has ended, the server still stands
  Pages pages{};                   ///< answered to GET, beside the assets
  /// Settings by name, as viewers see them: for the network thread. Outlives the endpoint; null: none.
  protocol::foxglove::ParameterStore* parameters = nullptr;
  const protocol::Run* description = nullptr;  ///< of the run; outlives the endpoint; null: not known
};

/// What has been served so far.
struct ServeSummary {
  std::uint64_t answers = 0;        ///< to telemetry, broken ones included
  std::uint64_t manual = 0;         ///< answers while a person drove
  std::uint64_t unusable = 0;       ///< telemetry that was broken or of another scene
  std::uint64_t connections = 0;    ///< simulators that were accepted
  std::uint64_t refusals = 0;       ///< simulators that came while another one drove
  std::uint64_t interventions = 0;  ///< commands that the gate had to change
  double delay = 0.0;               ///< last measured, telemetry to actuation [s]
  telemetry::RunSummary run{};      ///< of all connections; empty until the control thread has ended
};

/// The original controller program's place: answers every telemetry of one simulator with exactly one
/// complete, finite command, and says nothing unasked (docs/protocol.md). Its control thread owns the
/// controller; the network thread only reads, queues and sends.
///
/// Broken telemetry and that of other scenes is answered too: it counts as a cycle in which nothing was
/// measured (safety/guard.hpp). The controller is reset for each new connection, and after a silence; the
/// account of the run goes on over all of them.
class UdacityEndpoint final : public Endpoint {
 public:
  /// `controller` belongs to the control thread from now on.
  UdacityEndpoint(const ServeOptions& options, std::unique_ptr<controller::Controller> controller,
                  ServeHooks hooks);
  ~UdacityEndpoint() override;
  UdacityEndpoint(const UdacityEndpoint&) = delete;
  UdacityEndpoint& operator=(const UdacityEndpoint&) = delete;

  /// Ends the control thread. Call it before the server is destroyed.
  void stop();
  /// Any thread; complete after stop().
  [[nodiscard]] ServeSummary summary() const;

  void on_start(net::Server& server) override;
  [[nodiscard]] net::UpgradeAnswer on_upgrade(const net::UpgradeRequest& request) override;
  void on_open(net::ConnectionId id) override;
  void on_message(net::ConnectionId id, std::string_view bytes, bool binary) override;
  void on_close(net::ConnectionId id, std::string_view why) override;

 private:
  using Clock = std::chrono::steady_clock;
  class Control;

  /// The one simulator that is driven. Network thread only.
  struct Session {
    net::ConnectionId id = 0;      ///< 0 = none
    std::string name{};            ///< for the log: its address
    bool is_stock = false;         ///< got our open packet: an Engine.IO client that expects pings and pongs
    bool is_version_3 = false;     ///< EIO=3: the server connects the namespace, the client pings
    bool knows_stop_plan = false;  ///< said so in its request: it gets one with each command
    bool has_spoken = false;
    bool has_left = false;       ///< said goodbye, though the connection still stands
    bool has_telemetry = false;  ///< telemetry has come
    bool is_reported_silent = false;
    int unanswered = 0;             ///< telemetry that waits for its answer
    Clock::time_point last_word{};  ///< heard or said
  };

  void hear_telemetry(std::string_view bytes);
  void hear_packet(protocol::UdacityPacket packet);
  [[nodiscard]] bool complain_about(const protocol::UdacityTelemetry& message);
  void send(net::ConnectionId id, std::string text);
  void send_open_packet(net::ConnectionId id);
  void ping(net::ConnectionId id);
  void watch();
  [[nodiscard]] bool is_quiet() const;

  ServeOptions options_;
  ServeHooks hooks_;
  SparseLog log_;
  net::Server* server_ = nullptr;
  Session session_;
  std::map<net::ConnectionId, Session> accepted_;  ///< between on_upgrade and on_open
  std::atomic<std::uint64_t> connections_{0};
  std::atomic<std::uint64_t> refusals_{0};
  std::atomic<std::uint64_t> unusable_{0};
  std::unique_ptr<Control> control_;
};

/// `chicane serve`: binds the port and answers simulators until `stop`. `viewer` (may be null) and `assets`
/// share the port. kIo with the sentence that helps when the port is taken.
[[nodiscard]] Result<ServeSummary> serve(const ServeOptions& options,
                                         std::unique_ptr<controller::Controller> controller, ServeHooks hooks,
                                         Endpoint* viewer, std::vector<net::Asset> assets,
                                         const std::atomic<bool>& stop);

}  // namespace chicane::wire
