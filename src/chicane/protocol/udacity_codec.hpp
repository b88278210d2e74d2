// SPDX-License-Identifier: MIT
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

/// The dialect of the Udacity Term-2 simulator's MPC scene (v1.45), from both ends. All of its signs and
/// units live here: on the wire steering is positive to the right, speed is in mph, a steering command is a
/// share of 25°; inside it is chicane's axes and SI. Byte for byte: docs/reference/wire.md. No locale, no
/// exception; input of any size and content is safe.
namespace chicane::protocol {

inline constexpr std::size_t kMaxUdacityMessage = 65536;  ///< longer texts are broken by definition [byte]
inline constexpr int kMaxUdacityLine = 25;  ///< points drawn for one line: each costs the original frame time
inline constexpr int kMaxUdacityStop = 64;  ///< points of a stop plan

/// Query item of a simulator that plays stop plans.
inline constexpr std::string_view kStopPlanItem = "stop_plan=1";

/// `null` instead of data: a person drives by keyboard.
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

/// A message of another scene of the simulator, or of another program.
struct UdacityForeign {
  bool is_telemetry = true;  ///< false: some other event, whose sender expects nothing of us
  std::string what{};        ///< e.g. "the telemetry of the scene 'PID Controller'"
};

/// A message that cannot be used, in words that name the field: "x: got \"NaN\", expected a number".
struct UdacityBroken {
  std::string reason{};
  bool is_event = true;  ///< false: not even an event (`42…`), so no answer is expected
};

/// Message from the simulator. The measurement lacks `delay`, which the receiver knows, and `time`, unless
/// `time_field` names the field that carries the simulator's time [s]. Waypoints may be 0 to 32.
using UdacityTelemetry =
    std::variant<model::Measurement, UdacityManual, UdacityPacket, UdacityForeign, UdacityBroken>;
[[nodiscard]] UdacityTelemetry parse_telemetry(std::string_view text, const std::string& time_field = {});

/// The answer to telemetry: command, plan (green) and reference (yellow). The lines are given in W and sent
/// in the frame of the car at `pose_at_receipt`, because the original draws them from where the car is when
/// they arrive: the predicted pose. Lines are thinned to kMaxUdacityLine points and end before the first
/// non-finite one. `stop`, if it has points and all are finite, travels in a field that the original ignores;
/// thinned to kMaxUdacityStop points, its times counted from `sampled` [s], when the telemetry was. Pre: the
/// command is finite.
[[nodiscard]] std::string encode_steer(const model::Command& command, const controller::Plan& plan,
                                       const model::Pose& pose_at_receipt, const safety::StopPlan& stop = {},
                                       double sampled = 0.0);
[[nodiscard]] std::string encode_manual();

/// Command from the controller, as the simulator reads it.
struct UdacitySteer {
  model::Command command;         ///< clamped as the simulator does: |steer| <= 25°, throttle in [-1, 1]
  std::vector<Vec2> plan{};       ///< mpc_*, in B at receipt [m]
  std::vector<Vec2> reference{};  ///< next_*, in B at receipt [m]
  safety::StopPlan stop{};        ///< times [s] count from the sampling of the telemetry; size 0: none came
  /// Clamped field in words: "steering_angle: got 12.5, expected a number in [-1, 1]"; empty: none.
  std::string clamped{};
};
using UdacityReply = std::variant<UdacitySteer, UdacityManual, UdacityPacket, UdacityBroken>;
[[nodiscard]] UdacityReply parse_reply(std::string_view text);

/// Telemetry as the simulator sends it: numbers as its C# prints floats (7 significant digits), keys in its
/// order, no blanks.
[[nodiscard]] std::string encode_telemetry(const model::Measurement& measurement);
[[nodiscard]] std::string encode_manual_telemetry();

}  // namespace chicane::protocol
