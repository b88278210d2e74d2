// SPDX-License-Identifier: MIT
// Messages of the Udacity simulator, from both ends: telemetry to a controller, commands to the simulator.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "chicane/base/vec2.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/model/state.hpp"
#include "chicane/safety/stop_player.hpp"

/// The simulator is Udacity's Term 2, MPC scene, v1.45 (docs/reference/wire.md has its bytes). This codec
/// alone converts its signs and units: in messages steering is positive to the right, speed is in mph, and a
/// steering command is a share of 25°. Independent of the locale, throws nothing; input of any size and
/// content is safe.
namespace chicane::protocol {

inline constexpr std::size_t kMaxUdacityMessage =
    65536;  ///< limit of a message [byte]; longer ones are broken
inline constexpr int kMaxUdacityLine =
    25;  ///< limit of points sent for a line: the original draws each of them slowly
inline constexpr int kMaxUdacityStop = 64;  ///< limit of points sent for a stop plan

/// Query item of a simulator that plays stop plans.
inline constexpr std::string_view kStopPlanItem = "stop_plan=1";

/// Message without data (`null`): a person drives by keyboard.
struct UdacityManual {};

/// Packets below the events (Engine.IO and Socket.IO).
enum class UdacityPacket : signed char {
  kOpen,        ///< `0{…}`
  kClose,       ///< `1`
  kPing,        ///< `2`
  kPong,        ///< `3`
  kConnect,     ///< `40…`
  kDisconnect,  ///< `41…`
  kIgnored,     ///< anything else that begins with a digit
};

/// Message of another scene of the simulator, or of another program.
struct UdacityForeign {
  bool is_telemetry = true;  ///< false: another event, whose sender expects no answer
  std::string what{};        ///< "the telemetry of the scene 'PID Controller'"
};

/// Message that cannot be used.
struct UdacityBroken {
  std::string reason{};  ///< names the field: "x: got \"NaN\", expected a number"
  bool is_event = true;  ///< false: no event (`42…`), whose sender expects no answer
};

/// Message from the simulator. The measurement lacks `delay`, which the receiver knows, and `time`, unless
/// `time_field` names the field that carries the simulator's time [s]. Waypoints may be 0 to 32.
using UdacityTelemetry =
    std::variant<model::Measurement, UdacityManual, UdacityPacket, UdacityForeign, UdacityBroken>;
[[nodiscard]] UdacityTelemetry parse_telemetry(std::string_view text, const std::string& time_field = {});

/// Answer to telemetry: command, plan (green) and reference (yellow). Lines are given in W and sent in the
/// frame of the car at `pose_at_receipt`, the predicted pose at which the original will draw them. They are
/// thinned to kMaxUdacityLine points and end before the first one that is not finite. `stop`, if it has
/// points and all are finite, is sent in a field that the original ignores: thinned to kMaxUdacityStop
/// points, with times counted from `sampled` [s], the time of the telemetry. Pre: the command is finite.
[[nodiscard]] std::string encode_steer(const model::Command& command, const controller::Plan& plan,
                                       const model::Pose& pose_at_receipt, const safety::StopPlan& stop = {},
                                       double sampled = 0.0);
[[nodiscard]] std::string encode_manual();

/// Command from the controller, as the simulator reads it.
struct UdacitySteer {
  model::Command command;         ///< clamped as the simulator does: |steer| <= 25°, throttle in [-1, 1]
  std::vector<Vec2> plan{};       ///< mpc_*, in B at receipt [m]
  std::vector<Vec2> reference{};  ///< next_*, in B at receipt [m]
  safety::StopPlan stop{};        ///< times [s] count from the time of the telemetry; size 0: none was sent
  /// Sentence about a field that was clamped: "steering_angle: got 12.5, expected a number in [-1, 1]";
  /// empty: none.
  std::string clamped{};
};
using UdacityReply = std::variant<UdacitySteer, UdacityManual, UdacityPacket, UdacityBroken>;
[[nodiscard]] UdacityReply parse_reply(std::string_view text);

/// Telemetry with the bytes of the simulator's: numbers as C# prints floats (7 significant digits), keys in
/// the same order, no blanks.
[[nodiscard]] std::string encode_telemetry(const model::Measurement& measurement);
[[nodiscard]] std::string encode_manual_telemetry();

}  // namespace chicane::protocol
