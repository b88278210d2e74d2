// SPDX-License-Identifier: MIT
#include "chicane/ros/node_clock.hpp"

#include <fmt/format.h>

namespace chicane::ros {

std::string NodeClock::tick(std::int64_t time) {
  if (!is_simulated_) return {};
  if (has_ticked_ && time >= time_) {
    time_ = time;
    return {};
  }
  std::string news = has_ticked_ ? fmt::format("/clock went back by {:.1f} s: a simulation that began anew?",
                                               1e-9 * static_cast<double>(time_ - time))
                                 : std::string("/clock is there: time is simulated");
  base_ = now();
  first_ = time_ = time;
  has_ticked_ = true;
  return news;
}

std::int64_t NodeClock::stamp_now() const {
  if (is_simulated_) return time_;
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace chicane::ros
