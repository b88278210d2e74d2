// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "chicane/base/option.hpp"

namespace chicane::safety {

/// What is estimated of the car while it drives. Fixed when a run starts.
struct IdentifyOptions {
  bool during_run = false;  ///< delay, offset and gain of the steering (safety/actuator_estimator.hpp)

  friend bool operator==(const IdentifyOptions&, const IdentifyOptions&) = default;
};
/// The fields with their units and ranges, for files and messages.
[[nodiscard]] std::span<const Option> identify_options() noexcept;

}  // namespace chicane::safety
