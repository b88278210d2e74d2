// SPDX-License-Identifier: MIT
#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <string>

#include "chicane/base/angle.hpp"

namespace chicane::apps {
namespace {

constexpr std::chrono::milliseconds kTerminalPeriod{100};
constexpr double kLinePeriod = 10.0;  // [s] of the run

std::string line(const telemetry::Frame& frame) {
  const double speed = frame.measurement.speed;
  const double error = frame.has_truth ? frame.lateral_error : frame.result.report.lateral_error;
  const std::string place =
      frame.has_truth ? fmt::format("lap {:<3} {:6.0f} m ", frame.lap + 1, frame.s) : "";
  const std::string solve =
      frame.solve_time > 0.0 ? fmt::format("  solve {:5.0f} µs", 1e6 * frame.solve_time) : "";
  const std::string beside = std::isfinite(error) ? fmt::format("error {:+6.2f} m", error) : "error unknown";
  return fmt::format("{:7.1f} s  {}{:6.1f} mph  {}{}  {}", frame.time, place, mps_to_mph(speed), beside,
                     solve, sentence_of(frame.situation));
}

}  // namespace

std::string line_of(const telemetry::CompletedLap& lap) {
  const std::string_view verdict = !std::isfinite(lap.min_edge_distance) ? ""  // the road is not known
                                   : lap.is_clean                        ? ", clean"
                                                                         : ", off the road";
  return fmt::format("lap {}: {:.2f} s, {:.1f} mph in the mean{}", lap.lap, lap.lap_time,
                     mps_to_mph(lap.mean_speed), verdict);
}

Progress::Progress() : is_terminal_{isatty(STDERR_FILENO) == 1} {}

Progress::~Progress() {
  if (has_line_) fmt::print(stderr, "\n");
}

void Progress::show(const telemetry::Frame& frame) {
  for (const std::string& notice : notices_.look_at(frame)) say(notice);
  if (is_terminal_) {
    const Clock::time_point now = Clock::now();
    if (now < next_) return;
    next_ = now + kTerminalPeriod;
    has_line_ = true;
    fmt::print(stderr, "\r{}\x1b[K", line(frame));  // and clear what is left of the line before
    std::fflush(stderr);
  } else if (frame.time >= next_run_time_) {
    next_run_time_ = frame.time + kLinePeriod;
    fmt::print(stderr, "{}\n", line(frame));
  }
}

void Progress::say(std::string_view line) {
  fmt::print(stderr, "{}{}\n", has_line_.exchange(false) ? "\n" : "", line);
}

}  // namespace chicane::apps
