// SPDX-License-Identifier: MIT
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

/// Input and output of one control step, to the last bit: enough to compute it again.
struct Step {
  std::uint64_t cycle = 0;
  model::Measurement measurement;
  model::Command command;  ///< command after the gate
  controller::Rung rung = controller::Rung::kController;
  bool gated = false;
  double step_time = 0.0;  ///< duration of the control step [s], wall clock

  bool begins = false;                     ///< a run begins: controller and gate have forgotten everything
  bool has_measurement = true;             ///< false: what came was unusable, the controller was not asked
  std::optional<model::Command> manual{};  ///< a person's command, sent in the controller's place
  double gate_interval = 0.0;              ///< time since the previous command, by the gate's clock [s]
  double longest_interval = 0.0;           ///< the longest lately [s]
  std::uint32_t deadline_spent_at = 0;     ///< DeadlineLog::spent_at
};

/// The channel of recordings that holds every step, as a ROS 2 message.
inline constexpr std::string_view kStepTopic = "/chicane/step";
inline constexpr std::string_view kStepType = "chicane_msgs/msg/Step";
[[nodiscard]] std::string_view step_schema();

/// CDR as in ros_messages.hpp. Every double keeps its bits, not-a-number included.
[[nodiscard]] std::string encode_step(const telemetry::Frame& frame);
/// Step from its bytes; none if they are no such message.
[[nodiscard]] std::optional<Step> decode_step(std::string_view bytes);

/// The channel of the settings that changed during a run (ros_messages.hpp, encode_change()).
inline constexpr std::string_view kChangeTopic = "/chicane/change";
/// Change from its bytes; none if they are no such message, or hold more than fits.
[[nodiscard]] std::optional<telemetry::Change> decode_change(std::string_view bytes);

}  // namespace chicane::protocol
