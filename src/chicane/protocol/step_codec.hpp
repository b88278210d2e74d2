// SPDX-License-Identifier: MIT
// Step: input and output of one control step in recordings, from which the step can be repeated.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "chicane/controller/controller.hpp"
#include "chicane/model/state.hpp"
#include "chicane/telemetry/frame.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::protocol {

/// Input and output of one control step, bit for bit: enough to compute the step again.
struct Step {
  std::uint64_t cycle = 0;
  model::Measurement measurement;
  model::Command command;  ///< command after the gate
  controller::Rung rung = controller::Rung::kController;
  bool gated = false;      ///< the gate changed the command
  double step_time = 0.0;  ///< duration of the control step [s], wall clock

  bool begins = false;          ///< a run begins: controller and gate were reset
  bool has_measurement = true;  ///< false: the measurement was unusable, the controller did not run
  std::optional<model::Command> manual{};  ///< command of a person, sent in place of the controller's
  double gate_interval = 0.0;              ///< time since the previous command, by the gate's clock [s]
  double longest_interval = 0.0;           ///< longest recent interval between commands [s]
  std::uint32_t deadline_spent_at = 0;     ///< DeadlineLog::spent_at
};

/// Topic of recordings that has every step, and its type.
inline constexpr std::string_view kStepTopic = "/chicane/step";
inline constexpr std::string_view kStepType = "chicane_msgs/msg/Step";
/// Definition of that type in ROS 2's .msg language.
[[nodiscard]] std::string_view step_schema();

/// Bytes of the step of a frame: CDR as in ros_messages.hpp. Every double has its bits, also not-a-number.
[[nodiscard]] std::string encode_step(const telemetry::Frame& frame);
/// Step from its bytes; none if they are no such message.
[[nodiscard]] std::optional<Step> decode_step(std::string_view bytes);

/// Topic of the settings that changed during a run (ros_messages.hpp, encode_change()).
inline constexpr std::string_view kChangeTopic = "/chicane/change";
/// Change from its bytes; none if they are no such message, or their texts are longer than a Change has room
/// for.
[[nodiscard]] std::optional<telemetry::Change> decode_change(std::string_view bytes);

}  // namespace chicane::protocol
