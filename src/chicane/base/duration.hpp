// SPDX-License-Identifier: MIT
// Durations of the clock as numbers of seconds, and back.
#pragma once

#include <chrono>

namespace chicane {

/// A duration in seconds.
[[nodiscard]] inline double seconds(std::chrono::nanoseconds duration) noexcept {
  return std::chrono::duration<double>(duration).count();
}
/// The duration of `seconds`, cut off to whole nanoseconds. Pre: |seconds| < 9e9.
[[nodiscard]] inline std::chrono::nanoseconds duration(double seconds) noexcept {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(seconds));
}

}  // namespace chicane
