// SPDX-License-Identifier: MIT
// Table of the fields of a frame, the message by which recordings and viewers know each control cycle.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <variant>

#include "chicane/base/text.hpp"
#include "chicane/model/state.hpp"
#include "chicane/telemetry/frame.hpp"

namespace chicane::protocol {

/// Time of the run, sent as builtin_interfaces/Time of ROS 2.
struct Stamp {
  double seconds = 0.0;  ///< [s]
};

/// Types of a frame's fields. A span points into the frame that it was taken from.
using FrameValue = std::variant<Stamp, bool, std::int8_t, std::uint8_t, std::int32_t, std::uint32_t,
                                std::uint64_t, double, std::span<const double>>;

/// Name for one value of an enumerated field.
struct FrameConstant {
  std::string_view name;  ///< "RUNG_BRAKE"
  int value = 0;
  std::string_view meaning;
  std::optional<Severity> severity{};  ///< severity of a state: command source, reason, solver status
};

/// One field of chicane_msgs/msg/Frame.
struct FrameField {
  std::string_view type;     ///< type as in .msg files: "float64", "float64[]"
  std::string_view name;     ///< name in snake_case with its unit: "steer_sent_rad"; SI and radians
  std::string_view meaning;  ///< meaning, with frame and sign if the name does not say them
  /// Value of a frame, also of one with not-a-number inside; unknown values are not-a-number. The alternative
  /// always fits `type`.
  FrameValue (*value)(const telemetry::Frame& frame) noexcept = nullptr;
  std::span<const FrameConstant> constants{};  ///< in the order of the definition; empty for a quantity
};

/// Fields that belong together.
struct FrameGroup {
  std::string_view title;  ///< one line; empty for the first group
  std::span<const FrameField> fields;
};

/// Fields of a frame in the order in which they are sent. Encoder (ros_messages.hpp) and definition of the
/// message follow from this table. The dashboard's types and the columns of its history follow from the
/// definition (web/src/protocol/messages.ts; CONTRIBUTING.md says how).
[[nodiscard]] std::span<const FrameGroup> frame_groups() noexcept;

/// Known motion of the car: the truth if the frame has it, else the measurement, with lateral velocity and
/// yaw rate not-a-number.
[[nodiscard]] model::State known_motion(const telemetry::Frame& frame) noexcept;

}  // namespace chicane::protocol
