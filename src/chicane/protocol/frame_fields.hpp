// SPDX-License-Identifier: MIT
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

/// A time of the run as ROS 2 sends it: builtin_interfaces/Time.
struct Stamp {
  double seconds = 0.0;  ///< [s]
};

/// What a field of a frame can hold. A span points into the frame that it was taken from.
using FrameValue = std::variant<Stamp, bool, std::int8_t, std::uint8_t, std::int32_t, std::uint32_t,
                                std::uint64_t, double, std::span<const double>>;

/// A name for one value of a field that tells cases apart.
struct FrameConstant {
  std::string_view name;  ///< "RUNG_BRAKE"
  int value = 0;
  std::string_view meaning;
  std::optional<Severity> severity{};  ///< of a state: source of the command, its reason, the solver's status
};

/// One field of chicane_msgs/msg/Frame.
struct FrameField {
  std::string_view type;     ///< in the language of .msg files: "float64", "float64[]"
  std::string_view name;     ///< in snake_case, ending with its unit: "steer_sent_rad"; SI and radians
  std::string_view meaning;  ///< with frame and sign where the name does not tell them
  /// Of a frame, also of one with not-a-number inside; what is unknown is not-a-number. Its alternative is
  /// always the one of `type`.
  FrameValue (*value)(const telemetry::Frame& frame) noexcept = nullptr;
  std::span<const FrameConstant> constants{};  ///< in the order of the definition; empty for a quantity
};

struct FrameGroup {
  std::string_view title;  ///< a sentence, in one line; empty for the first group
  std::span<const FrameField> fields;
};

/// The fields of a frame in the order they are sent in: the one place where they are listed. Encoder
/// (ros_messages.hpp) and definition of the message follow from this table, and from the definition the
/// dashboard's types and the columns of its history (web/src/protocol/messages.ts; CONTRIBUTING.md says how).
[[nodiscard]] std::span<const FrameGroup> frame_groups() noexcept;

/// What is known of the car's motion: the truth, or what was measured; then lateral speed and yaw rate are
/// not-a-number.
[[nodiscard]] model::State known_motion(const telemetry::Frame& frame) noexcept;

}  // namespace chicane::protocol
