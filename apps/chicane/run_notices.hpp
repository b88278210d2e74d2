// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "chicane/telemetry/frame.hpp"

namespace chicane::apps {

/// Finds in the situations of a run what its operator has to know at once: that the controller's commands are
/// replaced or the car is stuck, why, what ends it, and that it has ended. At most two lines for each second
/// of the run.
class RunNotices {
 public:
  /// The lines that a frame gives rise to; mostly none.
  [[nodiscard]] std::vector<std::string> look_at(const telemetry::Frame& frame);

 private:
  [[nodiscard]] std::string ended(double time);

  double last_time_ = 0.0;
  // The event that goes on, or ended less than telemetry::kAlarmPause ago.
  std::string said_;            ///< printed last; empty: none
  double said_at_ = 0.0;        ///< [s]
  double began_ = 0.0;          ///< [s]
  double ended_ = 0.0;          ///< first step after it [s]
  bool goes_on_ = false;        ///< in the last step
  std::uint64_t replaced_ = 0;  ///< count of commands
};

}  // namespace chicane::apps
