// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/protocol/udacity_codec.hpp"
#include "chicane/safety/stop_player.hpp"

namespace chicane::wire {

/// What the actuators do at the simulator's end of the connection (docs/protocol.md §5): the
/// answers are picked up one telemetry later, and when they cease the car is stopped (safety/stop_player.hpp)
/// by what came with the last one. All times are the simulated world's [s]; they do not decrease. One thread.
///
/// A controller that sends no stop plan is waited for max(0.25 s, 3 times the median of its last nine
/// cycles): what it answers so slowly as a rule is no silence.
class CommandReceiver {
 public:
  CommandReceiver(const model::VehicleParams& vehicle, safety::Receiver receiver) noexcept
      : player_{vehicle, 0.0, receiver} {}

  /// Telemetry is sampled at `time`, and the answer to the one before acts from now on. An answer that came
  /// after the command timeout is too old for that: it is not used; false says so.
  bool sampled(double time) noexcept;
  /// The answer to the last telemetry has come.
  void answered(const protocol::UdacitySteer& steer) noexcept;
  /// The connection has ended: no answer is waited for.
  void disconnected() noexcept;

  /// What the actuators do at `time`; `speed` is their own [m/s].
  [[nodiscard]] model::Command act(double time, double speed) noexcept;
  /// What act() has said last.
  [[nodiscard]] const model::Command& acting() const noexcept { return acting_; }
  /// Command timeout: no command has come for longer than usual, and the receiver stops the car, or has. A
  /// stop by the controller's guard, repeated with each of its commands, does not count.
  [[nodiscard]] bool is_timed_out() const noexcept { return is_timed_out_; }

 private:
  void add_cycle(double length) noexcept;

  safety::StopPlayer player_;
  std::optional<protocol::UdacitySteer> waiting_;
  bool has_any_ = false;    ///< a command has been picked up; until then the car stands
  double sampled_ = 0.0;    ///< the telemetry that was sent last
  double picked_up_ = 0.0;  ///< the command that acts
  double patience_ = safety::StopPlayer::kPatience;
  bool is_timed_out_ = false;
  double timed_out_since_ = -1.0;  ///< [s]
  model::Command received_, acting_;
  std::array<double, 9> cycles_{};  ///< [s]
  int cycle_count_ = 0;
};

}  // namespace chicane::wire
