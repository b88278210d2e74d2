// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>

#include "chicane/telemetry/frame.hpp"
#include "run_notices.hpp"

namespace chicane::apps {

/// A completed lap in words: "lap 2: 26.19 s, 97.1 mph in the mean, clean".
[[nodiscard]] std::string line_of(const telemetry::CompletedLap& lap);

/// Tells on stderr how a run goes: on a terminal one line that renews itself ten times a second, otherwise a
/// line every ten seconds of the run. Notices (run_notices.hpp) are lines of their own, at once.
class Progress {
 public:
  Progress();
  /// Leaves the cursor at the beginning of a line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(const telemetry::Frame& frame);
  /// A line of its own. Any thread.
  void say(std::string_view line);

 private:
  using Clock = std::chrono::steady_clock;
  bool is_terminal_;
  std::atomic<bool> has_line_{false};  ///< the cursor stands behind a line that will renew itself
  Clock::time_point next_{};
  double next_run_time_ = 10.0;
  RunNotices notices_;
};

}  // namespace chicane::apps
