// SPDX-License-Identifier: MIT
// Client in place of the original simulator: our car and track, driven by another controller program.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "chicane/base/result.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/protocol/udacity_codec.hpp"
#include "chicane/safety/stop_player.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/telemetry/frame.hpp"
#include "chicane/telemetry/metrics.hpp"
#include "chicane/wire/endpoint.hpp"

namespace chicane::wire {

/// Receiver at the simulator's end of the connection (docs/protocol.md, "Time"): an answer acts from the next
/// telemetry on. When answers cease, the receiver stops the car by the stop plan of the last answer
/// (safety/stop_player.hpp). All times are the simulated world's [s]; they do not decrease. One thread.
///
/// Without a stop plan the receiver waits for max(0.25 s, 3 times the median of the last nine cycles), so
/// that a slow controller does not count as silent.
class CommandReceiver {
 public:
  CommandReceiver(const model::VehicleParams& vehicle, safety::Receiver receiver) noexcept
      : player_{vehicle, 0.0, receiver} {}

  /// Telemetry was sampled at `time`: the answer to the one before acts from now on. False: that answer came
  /// after the command timeout, and is not used.
  bool sampled(double time) noexcept;
  /// The answer to the last telemetry has come.
  void answered(const protocol::UdacitySteer& steer) noexcept { waiting_ = steer; }
  /// The connection has ended: drops an answer that does not act yet.
  void disconnected() noexcept { waiting_.reset(); }

  /// Command of the actuators at `time`; `speed` is the car's [m/s].
  [[nodiscard]] model::Command act(double time, double speed) noexcept;
  /// Command that act() returned last.
  [[nodiscard]] const model::Command& acting() const noexcept { return acting_; }
  /// Whether the command has timed out: no command has come for longer than usual, and the receiver has begun
  /// to stop the car. Stops by the controller's guard do not count.
  [[nodiscard]] bool is_timed_out() const noexcept { return is_timed_out_; }

 private:
  safety::StopPlayer player_;                        ///< plays the stop plan
  std::optional<protocol::UdacitySteer> waiting_;    ///< answer that does not act yet
  bool has_any_ = false;                             ///< a command has acted; before that the car stands
  double sampled_ = 0.0;                             ///< time of the last telemetry [s]
  double picked_up_ = 0.0;                           ///< time since which the last answer acts [s]
  double patience_ = safety::StopPlayer::kPatience;  ///< time without an answer before the timeout [s]
  bool is_timed_out_ = false;                        ///< is_timed_out()
  double timed_out_since_ = -1.0;                    ///< time of the last timeout [s]
  model::Command received_, acting_;                 ///< command of the last answer, and of the last act()
  RecentMedian cycles_;                              ///< times from telemetry to telemetry [s]
};

/// Options of a simulator for a controller program. The car and its road are the scenario's.
struct SimulateOptions {
  /// Address of the controller; the default is hard-coded in the original simulator.
  std::string url = "ws://127.0.0.1:4567/socket.io/?EIO=4&transport=websocket";
  /// Shell command that starts the controller; empty: it runs already. It is started again when it ends, and
  /// ended with this program. Its standard output is discarded, its standard error is shared.
  std::string server_command{};
  double manual_time = 0.0;  ///< time of manual driving at the start: telemetry is null, the car stands [s]
  // Times chosen.
  std::chrono::milliseconds retry_after{250};      ///< time between attempts to connect
  std::chrono::milliseconds complain_after{1000};  ///< silence before a complaint
  std::chrono::milliseconds give_up_after{5000};   ///< silence before it reconnects
  std::chrono::milliseconds lost_after{30000};     ///< time without a connection before the run ends
  /// Time without any usable answer after which the run ends. 0: never; the run waits and reconnects.
  std::chrono::milliseconds hopeless_after{0};
};

/// Callbacks of simulate(); empty functions are not called.
struct SimulateHooks {
  std::function<void(const telemetry::Frame&)> on_frame{};       ///< called with each answer
  std::function<void(const telemetry::CompletedLap&)> on_lap{};  ///< called after each lap, the last one too
  std::function<void(std::string_view)> log{};  ///< gets lines about the connection and broken answers
};

/// Report on a run, as `drive` gives it, and on the controller program.
struct SimulateReport {
  telemetry::RunSummary run;  ///< step_time is the time to the answer, the controller's own latency included
  std::uint64_t connections = 0;
  std::uint64_t answers = 0;         ///< usable ones
  std::uint64_t broken_answers = 0;  ///< answers that would have stalled the original for ever
  std::uint64_t extra_answers = 0;   ///< answers without a request
  std::uint64_t silences = 0;        ///< telemetry without an answer within give_up_after
  std::uint64_t server_starts = 0;
  std::uint64_t stops = 0;         ///< times the car was stopped because no command came
  std::uint64_t late_answers = 0;  ///< answers after the car's stop began: not used
};

/// `chicane simulate`: our car and track in place of the original simulator, in real time (docs/protocol.md,
/// "Time"). Physics never waits. The next telemetry is sampled `scenario.turn_around` after an answer came;
/// from then on the answer acts. A broken answer is reported and counted, and the previous command stays.
/// When commands cease, `scenario.guard.receiver` stops the car; when they return, the car drives on.
///
/// Uses track, car, plant_options, vehicle, guard.receiver, sensor, seed, laps, time_limit, turn_around and
/// waypoints_sent of the scenario. Ends, with the results so far, when the laps are driven, the car is lost,
/// the time is up, the controller stays away, or `stop` is set. Fails when the scenario cannot be built, or
/// nothing ever answers at `url`.
[[nodiscard]] Result<SimulateReport> simulate(const SimulateOptions& options,
                                              const scenario::Scenario& scenario, const SimulateHooks& hooks,
                                              const std::atomic<bool>& stop);

/// Controller program that this program starts, by a shell, in a process group of its own whose head is a
/// guard process. The group ends with this object; if this program dies, the guard process ends the group.
class ServerProcess {
 public:
  ServerProcess(std::string command, SparseLog& log) : command_{std::move(command)}, log_{log} {}
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;
  /// Asks all processes of the group to end, and kills them after a second.
  ~ServerProcess();

  [[nodiscard]] std::uint64_t starts() const { return starts_; }

  /// Starts the command, also after its death, but at most once a second. Call it from one thread that lives
  /// as long as this: the guard process watches that thread. No effect for an empty command.
  void keep_running(std::chrono::steady_clock::time_point now);

 private:
  /// Starts the guard process, which starts the command.
  void start();

  std::string command_;
  SparseLog& log_;
  int pid_ = -1;                                     ///< process id of guard and group; -1: none runs
  std::uint64_t starts_ = 0;                         ///< starts so far
  std::chrono::steady_clock::time_point started_{};  ///< time of the last start
};

}  // namespace chicane::wire
