// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/telemetry/frame.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::wire {

/// How the simulator meets a controller program. What it simulates is the scenario's.
struct SimulateOptions {
  std::string url =
      "ws://127.0.0.1:4567/socket.io/?EIO=4&transport=websocket";  ///< the original's, hard-coded there
  /// Shell command that starts the controller; empty = it runs already. Started again when it dies, ended
  /// with us. Its standard output is thrown away, its standard error is ours.
  std::string server_command{};
  double manual_time = 0.0;  ///< a person "drives" for so long first: telemetry is null, the car stands [s]
  std::chrono::milliseconds retry_after{250};      ///< between attempts to connect
  std::chrono::milliseconds complain_after{1000};  ///< without an answer
  std::chrono::milliseconds give_up_after{5000};   ///< without an answer: connect anew
  std::chrono::milliseconds lost_after{30000};     ///< without a connection: the run ends
  /// Without any usable answer: the run ends. 0: it waits for ever, connecting anew, as a person would.
  std::chrono::milliseconds hopeless_after{0};
};

struct SimulateHooks {
  std::function<void(const telemetry::Frame&)> on_frame{};  ///< with each answer
  std::function<void(const telemetry::CompletedLap&)>
      on_lap{};                                 ///< when a lap was completed, the last one too
  std::function<void(std::string_view)> log{};  ///< one line about the connection or a broken answer
};

/// A run, as `drive` reports it, and how the controller program behaved.
struct SimulateReport {
  telemetry::RunSummary run;  ///< step_time is the time to the answer, the controller's own latency included
  std::uint64_t connections = 0;
  std::uint64_t answers = 0;         ///< usable ones
  std::uint64_t broken_answers = 0;  ///< that would have stalled the original for ever
  std::uint64_t extra_answers = 0;   ///< that were not asked for
  std::uint64_t silences = 0;        ///< telemetry without an answer within give_up_after
  std::uint64_t server_starts = 0;
  std::uint64_t stops = 0;         ///< times the car was stopped because no command came
  std::uint64_t late_answers = 0;  ///< not used, because the car was being stopped when they came
};

/// `chicane simulate`: our car and track as the original simulator's client, in real time
/// (docs/protocol.md §5). Physics never waits; each answer is picked up `scenario.turn_around`
/// after it came, when the next telemetry is sampled, and acts from there until the next one. A broken answer
/// is named, counted, and driven past with the command that was. When commands cease the car is stopped as
/// `scenario.guard.receiver` says (command_receiver.hpp); when they come again it drives on.
///
/// Uses of the scenario: track, car, plant_options, vehicle, guard.receiver, sensor, seed, laps, time_limit,
/// turn_around, waypoints_sent. Ends when the laps are driven, the car is lost, time is up, the controller
/// stays away, or `stop` is set: always with the results so far. Fails when the scenario cannot be built or
/// nothing ever answers at `url`.
[[nodiscard]] Result<SimulateReport> simulate(const SimulateOptions& options,
                                              const scenario::Scenario& scenario, const SimulateHooks& hooks,
                                              const std::atomic<bool>& stop);

}  // namespace chicane::wire
