// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>

#include "chicane/base/result.hpp"

namespace chicane::controller {

/// An option and the range it must lie in, bounds included.
struct OptionRange {
  const char* name;  ///< as the user knows it, "cubic_mpc.step_length"
  double value;
  double low;
  double high;
};

/// kInvalidArgument naming the first option out of range ("pid.integral_gain: got -1, expected 0 to 10"); NaN
/// is.
[[nodiscard]] Result<void> check_ranges(std::initializer_list<OptionRange> ranges);

}  // namespace chicane::controller
