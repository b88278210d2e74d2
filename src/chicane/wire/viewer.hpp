// SPDX-License-Identifier: MIT
// Endpoint of viewers: publishes a run by the Foxglove WebSocket protocol.
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

/// Services of a run for viewers, called on the network thread: they hand the request over and return. Empty
/// functions are not offered. The viewer gets the sentence of a failure.
struct ViewerServices {
  std::function<Result<void>(bool paused)> pause;  ///< "/pause", std_srvs/srv/SetBool
  std::function<Result<void>()> step;   ///< "/step", std_srvs/srv/Trigger: one control cycle while paused
  std::function<Result<void>()> reset;  ///< "/reset", std_srvs/srv/Trigger: restarts the run
  /// Service "/what_if", chicane_msgs/srv/Ask: begins to compute another future; returns its number as a
  /// text.
  std::function<Result<std::string>(std::string_view question)> what_if{};
  /// Service "/rival", chicane_msgs/srv/Ask: begins or ends a race against a second car; returns its number
  /// as a text.
  std::function<Result<std::string>(std::string_view question)> rival{};
};

/// Options of a ViewerEndpoint.
struct ViewerOptions {
  double rate_limit = 60.0;  ///< most frames sent per second [Hz], (0, 1000]; chosen: as many as screens show
  protocol::Run run{};       ///< description of the run
  ViewerServices services{};
  /// Settings of the run; outlives the endpoint; null: none are offered.
  protocol::foxglove::ParameterStore* parameters = nullptr;
  std::function<double()> clock{};  ///< clock [s], which rises; empty: the machine's steady clock
};

/// Endpoint that shows a run to viewers by the Foxglove WebSocket protocol (docs/viewer.md): our dashboard,
/// Foxglove, Lichtblick, PlotJuggler or a script. Only the newest frame is kept between the control thread
/// and the network thread, and again before each viewer: slow viewers get fewer frames and delay nothing.
///
/// Viewers that may only watch (net::UpgradeRequest::may_control) can neither call services nor set
/// parameters.
///
/// Each subscriber gets the laps and changes of the whole run. The query of a viewer's address may ask for
/// more:
///
///     past     offers the topic "/chicane/past": frames of the last minutes (run_memory.hpp), the newest
///     first,
///              sent after present frames
///     paced    sends no more than the viewer acknowledges in time (run_memory.hpp, foxglove::Received), the
///              newest frame before everything else
///
/// Must outlive the server that it is started with.
class ViewerEndpoint final : public Endpoint {
 public:
  explicit ViewerEndpoint(ViewerOptions options);

  /// Publishes a frame; called on the control thread. Neither waits nor allocates.
  void publish(const telemetry::Frame& frame) noexcept { latest_.put(frame); }
  /// Publishes a lap that was completed at `time` [s], before the next frame; called on the control thread.
  void publish(const telemetry::CompletedLap& lap, double time) noexcept { latest_lap_.put({lap, time}); }
  /// Replaces the description of the run; Run::building and is_paused stay. Any thread, but not during
  /// on_start().
  void set_run(protocol::Run run);
  /// Publishes an answer on the run's limit. Any thread.
  void set_limit(lap_time::LimitAnswer answer);
  /// Changes the description of the run, except for its road. Any thread.
  void change_run(std::function<void(protocol::Run&)> change);
  /// Reports a pause that no viewer asked for. Any thread.
  void set_paused(bool paused) {
    change_run([paused](protocol::Run& run) { run.is_paused = paused; });
  }
  /// Reports the end of the run: a word ("finished", "stopped", "failed") and a sentence. A restart of the
  /// run revokes it. Any thread.
  void set_end(std::string kind, std::string reason);
  /// Longest waits for viewers at the end of a run; chosen.
  struct Patience {
    std::chrono::milliseconds silent{2000};   ///< time in which no viewer reads anything
    std::chrono::milliseconds whole{10'000};  ///< time in all
  };
  /// Sends all waiting messages and closes the connections. Returns when the viewers have gone, or after
  /// `patience`. Call it at the end of the run, on the thread that drives.
  void dismiss(const Patience& patience);
  void dismiss() { dismiss(Patience{}); }

  void on_start(net::Server& server) override;
  [[nodiscard]] net::UpgradeAnswer on_upgrade(const net::UpgradeRequest& request) override;
  void on_open(net::ConnectionId id) override;
  void on_message(net::ConnectionId id, std::string_view bytes, bool binary) override;
  void on_close(net::ConnectionId id, std::string_view why) override;

 private:
  /// Connected viewer.
  struct Client {
    bool may_control = false;        ///< may call services and set parameters
    bool wants_past = false;         ///< asked for past frames
    std::optional<LinkPace> pace{};  ///< congestion control; none: messages are sent at once
    std::uint64_t past_before = 0;   ///< past frames with lower numbers are not sent yet
    bool is_behind = false;          ///< paced, and the newest frame is not sent yet
    double whole_sent_at = 0.0;      ///< time at which all topics of a frame were sent last [s]
    std::set<std::uint32_t>
        owed{};                   ///< paced, channels whose description is to be sent after the newest frame
    double newest_sent_at = 0.0;  ///< time at which a newest frame was sent last [s]
    std::optional<protocol::foxglove::Received> heard{};   ///< acknowledgement that is not answered yet
    double heard_at = 0.0;                                 ///< time of its arrival [s]
    std::uint64_t next_lap = 0;                            ///< number from which laps are not sent yet
    std::uint64_t next_change = 0;                         ///< number from which changes are not sent yet
    std::map<std::uint32_t, std::uint32_t> subscriptions;  ///< subscription by channel
    bool wants_all_parameters = false;                     ///< follows all parameters
    std::set<std::string, std::less<>> wanted_parameters;  ///< names of the parameters that it follows
  };
  /// Service that viewers may call.
  struct ServiceEntry {
    protocol::foxglove::Service description;
    std::function<Result<std::string>(std::string_view request)>
        call;  ///< returns the sentence of its success
  };

  /// Adds a service.
  void offer(std::string_view name, std::string_view type,
             std::function<Result<std::string>(std::string_view)> call);
  /// Calls tick() at the rate limit, from now on.
  void schedule();
  /// Sends everything that is new to all viewers.
  void tick();
  /// Drops messages from before a restart of the run.
  void forget();
  /// Sends applied changes in order, and changed parameters to viewers that follow them. `begins`: the newest
  /// frame belongs to a run that began since the last call.
  void tell_changes(bool begins);
  void send_parameters(const std::vector<protocol::foxglove::Parameter>& values);
  /// Keeps a new lap for all viewers; `begins` as in tell_changes().
  void note_lap(bool begins);
  /// Keeps the newest frame for viewers that connect later.
  void note_frame();
  /// Sends the newest frame first, then missing laps and changes, then past frames.
  void serve(net::ConnectionId id, Client& client);
  /// Sends the newest frame to a paced viewer, once there is room for it.
  void send_newest(net::ConnectionId id, Client& client);
  /// Sends descriptions that a paced viewer has subscribed to: a road is as large as a second of frames.
  void send_owed(net::ConnectionId id, Client& client);
  /// Sends a page of laps and changes; the next page follows when this one has been read.
  void send_kept(net::ConnectionId id, Client& client);
  /// Sends a page of past frames, backwards from the newest.
  void send_past(net::ConnectionId id, Client& client);
  /// Sends a binary message that must arrive, and counts its bytes if the viewer is paced.
  void deliver(net::ConnectionId id, Client& client, net::Bytes bytes);
  /// Number of messages that fit into the current page.
  [[nodiscard]] std::size_t room_for(net::ConnectionId id, const Client& client) const;
  /// Whether page and link have room for another message.
  [[nodiscard]] bool has_room(net::ConnectionId id, const Client& client) const;
  /// Whether a viewer has got everything of the run that it asked for.
  [[nodiscard]] bool has_all(net::ConnectionId id, const Client& client) const;
  /// Time by the endpoint's clock [s].
  [[nodiscard]] double now() const;
  /// Sends all topics of a cadence.
  void send_cadence(protocol::Cadence cadence);
  /// Sends the current content of a channel to its subscribers.
  void send_channel(std::uint32_t channel);
  void send_text(net::ConnectionId id, std::string text);
  /// Sends an error message to a viewer.
  void warn(net::ConnectionId id, std::string_view sentence);
  /// Runs a task on the network thread, or now if no server has started.
  void on_network(std::function<void()> task);

  // Requests of viewers (viewer_requests.cpp).
  void handle(net::ConnectionId id, const protocol::foxglove::Subscribe& message);
  void handle(net::ConnectionId id, const protocol::foxglove::Unsubscribe& message);
  void handle(net::ConnectionId id, const protocol::foxglove::GetParameters& message);
  void handle(net::ConnectionId id, const protocol::foxglove::SetParameters& message);
  void handle(net::ConnectionId id, const protocol::foxglove::SubscribeParameters& message);
  void handle(net::ConnectionId id, const protocol::foxglove::UnsubscribeParameters& message);
  void handle(net::ConnectionId id, const protocol::foxglove::CallService& message);
  void handle(net::ConnectionId id, const protocol::foxglove::Received& message);

  ViewerOptions options_;
  std::vector<ServiceEntry> services_;  ///< offered services, by their number
  std::string session_;                 ///< id of this session for viewers that connect again
  /// Completed lap, and the time of its end.
  struct TimedLap {
    telemetry::CompletedLap lap;
    double time = 0.0;  ///< [s]
  };
  Latest<telemetry::Frame> latest_;  ///< newest frame from the control thread
  Latest<TimedLap> latest_lap_;      ///< newest lap from the control thread
  telemetry::Frame frame_;           ///< frame that viewers get
  bool has_frame_ = false;           ///< frame_ is set
  RunMemory memory_;                 ///< messages for viewers that connect later
  telemetry::LapLedger ledger_;      ///< settings of each lap
  std::uint64_t cycle_ = 0;          ///< cycle of the last frame
  bool has_forgotten_ = false;       ///< forget() was called for a run whose first frame has not come yet
  std::mutex starting_;              ///< guards server_ until it is set
  net::Server* server_ = nullptr;
  std::map<net::ConnectionId, Client> clients_;   ///< connected viewers
  std::map<net::ConnectionId, Client> upgrades_;  ///< viewers between on_upgrade() and on_open()
};

}  // namespace chicane::wire
