// SPDX-License-Identifier: MIT
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

/// Receiver at the simulator's end of the connection (docs/protocol.md, "Time"): answers act one telemetry
/// later, and when they cease the car is stopped (safety/stop_player.hpp) by the stop plan of the last one.
/// All times are the simulated world's [s]; they do not decrease. One thread.
///
/// Without a stop plan the receiver waits for max(0.25 s, 3 times the median of the last nine cycles): a
/// controller that is always so slow is not silent.
class CommandReceiver {
 public:
  CommandReceiver(const model::VehicleParams& vehicle, safety::Receiver receiver) noexcept
      : player_{vehicle, 0.0, receiver} {}

  /// Samples telemetry at `time`; the previous answer acts from now on. False: that answer came after the
  /// command timeout, is too old and is not used.
  bool sampled(double time) noexcept;
  /// Reports that the answer to the last telemetry has come.
  void answered(const protocol::UdacitySteer& steer) noexcept;
  /// Reports that the connection has ended: no answer is awaited.
  void disconnected() noexcept;

  /// Command of the actuators at `time`; `speed` is the car's [m/s].
  [[nodiscard]] model::Command act(double time, double speed) noexcept;
  /// Command that act() returned last.
  [[nodiscard]] const model::Command& acting() const noexcept { return acting_; }
  /// Whether the command has timed out: none has come for longer than usual, and the receiver stops the car,
  /// or has. A stop by the controller's guard, repeated with each of its commands, does not count.
  [[nodiscard]] bool is_timed_out() const noexcept { return is_timed_out_; }

 private:
  safety::StopPlayer player_;
  std::optional<protocol::UdacitySteer> waiting_;
  bool has_any_ = false;    ///< a command has been picked up; until then the car stands
  double sampled_ = 0.0;    ///< the telemetry that was sent last
  double picked_up_ = 0.0;  ///< the command that acts
  double patience_ = safety::StopPlayer::kPatience;
  bool is_timed_out_ = false;
  double timed_out_since_ = -1.0;  ///< [s]
  model::Command received_, acting_;
  RecentMedian cycles_;  ///< [s]
};

/// Options of a simulator for a controller program. The car and its road are the scenario's.
struct SimulateOptions {
  std::string url =
      "ws://127.0.0.1:4567/socket.io/?EIO=4&transport=websocket";  ///< the original's, hard-coded there
  /// Shell command that starts the controller; empty = it runs already. Started again when it dies, ended
  /// with us. Its standard output is thrown away, its standard error is ours.
  std::string server_command{};
  double manual_time = 0.0;  ///< time of manual driving at the start: telemetry is null, the car stands [s]
  std::chrono::milliseconds retry_after{250};      ///< time between attempts to connect
  std::chrono::milliseconds complain_after{1000};  ///< silence before a complaint
  std::chrono::milliseconds give_up_after{5000};   ///< silence before it reconnects
  std::chrono::milliseconds lost_after{30000};     ///< time without a connection before the run ends
  /// Time without any usable answer after which the run ends. 0: it waits for ever and reconnects, as a
  /// person would.
  std::chrono::milliseconds hopeless_after{0};
};

struct SimulateHooks {
  std::function<void(const telemetry::Frame&)> on_frame{};       ///< called with each answer
  std::function<void(const telemetry::CompletedLap&)> on_lap{};  ///< called after each lap, the last one too
  std::function<void(std::string_view)> log{};  ///< one line about the connection or a broken answer
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

/// `chicane simulate`: our car and track as the original simulator's client, in real time (docs/protocol.md,
/// "Time"). Physics never waits; each answer takes effect `scenario.turn_around` after it came, when the next
/// telemetry is sampled, and acts until the next one. A broken answer is reported and counted, and the
/// previous command stays. When commands cease `scenario.guard.receiver` stops the car; when they return it
/// continues.
///
/// Uses of the scenario: track, car, plant_options, vehicle, guard.receiver, sensor, seed, laps, time_limit,
/// turn_around, waypoints_sent. Ends when the laps are driven, the car is lost, time is up, the controller
/// stays away, or `stop` is set: always with the results so far. Fails when the scenario cannot be built or
/// nothing ever answers at `url`.
[[nodiscard]] Result<SimulateReport> simulate(const SimulateOptions& options,
                                              const scenario::Scenario& scenario, const SimulateHooks& hooks,
                                              const std::atomic<bool>& stop);

/// The controller program that we started ourselves, by a shell, in a process group of its own with a guard
/// at its head. The group ends with this object; if our process dies, the guard ends it.
class ServerProcess {
 public:
  ServerProcess(std::string command, SparseLog& log) : command_{std::move(command)}, log_{log} {}
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;
  /// Asks all of the group to end, and kills them after a second.
  ~ServerProcess();

  [[nodiscard]] std::uint64_t starts() const { return starts_; }

  /// Starts the command, also after its death, but at most once a second. Call it from one thread that lives
  /// as long as this: the guard process watches that thread. No effect for an empty command.
  void keep_running(std::chrono::steady_clock::time_point now);

 private:
  void start();

  std::string command_;
  SparseLog& log_;
  int pid_ = -1;  ///< the guard's, and the group's
  std::uint64_t starts_ = 0;
  std::chrono::steady_clock::time_point started_{};
};

}  // namespace chicane::wire
