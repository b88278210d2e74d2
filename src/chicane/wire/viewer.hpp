// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/latest.hpp"
#include "chicane/base/result.hpp"
#include "chicane/protocol/foxglove_codec.hpp"
#include "chicane/protocol/ros_messages.hpp"
#include "chicane/telemetry/frame.hpp"
#include "chicane/telemetry/metrics.hpp"
#include "chicane/wire/endpoint.hpp"
#include "chicane/wire/run_memory.hpp"

namespace chicane::wire {

/// Requests of viewers to the run. Called on the network thread: hand the request over and return. An empty
/// function is not offered. A failure's sentence is shown to the operator.
struct ViewerServices {
  std::function<Result<void>(bool paused)> pause;  ///< "/pause", std_srvs/srv/SetBool
  std::function<Result<void>()> step;   ///< "/step", std_srvs/srv/Trigger: one control cycle while paused
  std::function<Result<void>()> reset;  ///< "/reset", std_srvs/srv/Trigger: restarts the run
  /// Service "/what_if", chicane_msgs/srv/Ask: begins to compute another future; its number as a text.
  std::function<Result<std::string>(std::string_view question)> what_if{};
  /// Service "/rival", chicane_msgs/srv/Ask: begins or ends a race against a second car; its number as a
  /// text.
  std::function<Result<std::string>(std::string_view question)> rival{};
};

struct ViewerOptions {
  double rate_limit = 60.0;  ///< frames per second sent at most [Hz]; (0, 1000]
  protocol::Run run{};
  ViewerServices services{};
  protocol::foxglove::ParameterStore* parameters =
      nullptr;                      ///< outlives the endpoint; null: none are offered
  std::function<double()> clock{};  ///< [s], rising; empty: the machine's steady clock
};

/// Shows a run to viewers: our dashboard, Foxglove, Lichtblick, PlotJuggler or a script, all by the Foxglove
/// WebSocket protocol (docs/viewer.md). The newest frame wins on its way from the control thread, and again
/// on its way to each viewer: slow ones see fewer frames and hold nothing up.
///
/// Viewers that may only watch (net::UpgradeRequest::may_control) get everything but services and set
/// parameters.
///
/// Laps and changes of the run are sent from its beginning to every subscriber. The query of a viewer's
/// address may ask for more: "past" offers the topic "/chicane/past", the frames of the last minutes before
/// it came (run_memory.hpp), the newest first, behind the present; "paced" sends no more than the viewer
/// acknowledges in time (run_memory.hpp, foxglove::Received), the newest frame before everything else.
///
/// Must outlive the server it is started with.
class ViewerEndpoint final : public Endpoint {
 public:
  explicit ViewerEndpoint(ViewerOptions options);

  /// One thread, the control thread: neither waits nor allocates.
  void publish(const telemetry::Frame& frame) noexcept { latest_.put(frame); }
  /// The same thread: a lap was completed at `time` [s], before the next frame.
  void publish(const telemetry::CompletedLap& lap, double time) noexcept { latest_lap_.put({lap, time}); }
  /// Sets another track, car or controller; Run::building and is_paused stay unchanged. Any thread, but not
  /// while on_start runs.
  void set_run(protocol::Run run);
  /// Publishes news of the run's limit. Any thread.
  void set_limit(lap_time::LimitAnswer answer);
  /// Part of it changes, the road excepted. Any thread.
  void change_run(std::function<void(protocol::Run&)> change);
  /// Reports a pause that no viewer asked for. Any thread.
  void set_paused(bool paused) {
    change_run([paused](protocol::Run& run) { run.is_paused = paused; });
  }
  /// Reports the end of the run: a word ("finished", "stopped", "failed") and a sentence. A restart revokes
  /// it. Any thread.
  void set_end(std::string kind, std::string reason);
  /// Wait of a run's end for viewers.
  struct Patience {
    std::chrono::milliseconds silent{2000};  ///< time without any of them reading
    std::chrono::milliseconds whole{10'000};
  };
  /// Sends all that waits and closes the connections; returns when viewers have gone, or when `patience` is
  /// over. Call it on the thread that runs the experiment, at its end.
  void dismiss(const Patience& patience);
  void dismiss() { dismiss(Patience{}); }

  void on_start(net::Server& server) override;
  [[nodiscard]] net::UpgradeAnswer on_upgrade(const net::UpgradeRequest& request) override;
  void on_open(net::ConnectionId id) override;
  void on_message(net::ConnectionId id, std::string_view bytes, bool binary) override;
  void on_close(net::ConnectionId id, std::string_view why) override;

 private:
  struct Client {
    bool may_control = false;
    bool wants_past = false;
    std::optional<LinkPace> pace{};  ///< none: all messages are sent at once
    std::uint64_t past_before = 0;   ///< frames of memory_ with lower numbers are still to be sent
    bool is_behind = false;          ///< paced, and the newest frame is not sent yet
    double whole_sent_at = 0.0;      ///< time of the last message with plan and all else [s]
    std::set<std::uint32_t> owed{};  ///< channels of descriptions, paced, sent behind the newest
    double newest_sent_at = 0.0;     ///< [s]
    std::optional<protocol::foxglove::Received> heard{};  ///< reading report to be answered
    double heard_at = 0.0;                                ///< [s]
    std::uint64_t next_lap = 0;                           ///< next message of memory_ for it
    std::uint64_t next_change = 0;
    std::map<std::uint32_t, std::uint32_t> subscriptions;  ///< channel → subscription
    bool wants_all_parameters = false;
    std::set<std::string, std::less<>> wanted_parameters;
  };
  struct ServiceEntry {
    protocol::foxglove::Service description;
    std::function<Result<std::string>(std::string_view request)> call;  ///< the sentence of its success
  };

  void offer(std::string_view name, std::string_view type,
             std::function<Result<std::string>(std::string_view)> call);
  void schedule();
  void tick();
  void forget();
  void tell_changes(bool begins);
  void send_parameters(const std::vector<protocol::foxglove::Parameter>& values);
  void note_lap(bool begins);
  void note_frame();
  void serve(net::ConnectionId id, Client& client);
  void send_newest(net::ConnectionId id, Client& client);
  void send_owed(net::ConnectionId id, Client& client);
  void send_kept(net::ConnectionId id, Client& client);
  void send_past(net::ConnectionId id, Client& client);
  void deliver(net::ConnectionId id, Client& client, net::Bytes bytes);
  [[nodiscard]] std::size_t room_for(net::ConnectionId id, const Client& client) const;
  [[nodiscard]] bool has_room(net::ConnectionId id, const Client& client) const;
  [[nodiscard]] bool has_all(net::ConnectionId id, const Client& client) const;
  [[nodiscard]] double now() const;
  void send_cadence(protocol::Cadence cadence);
  void send_channel(std::uint32_t channel);
  void send_text(net::ConnectionId id, std::string text);
  void warn(net::ConnectionId id, std::string_view sentence);
  void on_network(std::function<void()> task);

  void handle(net::ConnectionId id, const protocol::foxglove::Subscribe& message);
  void handle(net::ConnectionId id, const protocol::foxglove::Unsubscribe& message);
  void handle(net::ConnectionId id, const protocol::foxglove::GetParameters& message);
  void handle(net::ConnectionId id, const protocol::foxglove::SetParameters& message);
  void handle(net::ConnectionId id, const protocol::foxglove::SubscribeParameters& message);
  void handle(net::ConnectionId id, const protocol::foxglove::UnsubscribeParameters& message);
  void handle(net::ConnectionId id, const protocol::foxglove::CallService& message);
  void handle(net::ConnectionId id, const protocol::foxglove::Received& message);

  ViewerOptions options_;
  std::vector<ServiceEntry> services_;
  std::string session_;
  struct TimedLap {
    telemetry::CompletedLap lap;
    double time = 0.0;  ///< [s]
  };
  Latest<telemetry::Frame> latest_;
  Latest<TimedLap> latest_lap_;
  telemetry::Frame frame_;
  bool has_frame_ = false;
  RunMemory memory_;
  telemetry::LapLedger ledger_;
  std::uint64_t cycle_ = 0;     ///< cycle of the last frame
  bool has_forgotten_ = false;  ///< the next run begins, and its first frame has not come yet
  std::mutex starting_;         ///< guards server_ until it is set
  net::Server* server_ = nullptr;
  std::map<net::ConnectionId, Client> clients_;
  std::map<net::ConnectionId, Client> upgrades_;  ///< upgrades between on_upgrade and on_open
};

}  // namespace chicane::wire
