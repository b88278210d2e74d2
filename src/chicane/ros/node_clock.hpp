// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace chicane::ros {

/// The time by which a node counts: this machine's, or that of /clock, which stands where nobody sends it. As
/// points of the monotonic clock, which begin when the node does. One thread.
class NodeClock {
 public:
  using Clock = std::chrono::steady_clock;

  explicit NodeClock(bool is_simulated) : is_simulated_{is_simulated} {}

  [[nodiscard]] bool is_simulated() const { return is_simulated_; }
  /// /clock says that it is `time` [ns]. What is to be said of it; empty: nothing. A time that goes back, as
  /// where a simulation begins anew, is where the node's time goes on.
  [[nodiscard]] std::string tick(std::int64_t time);

  [[nodiscard]] Clock::time_point now() const {
    return is_simulated_ ? base_ + std::chrono::nanoseconds(time_ - first_) : Clock::now();
  }
  /// Now in the numbers of stamps [ns]: since 1970, or of /clock.
  [[nodiscard]] std::int64_t stamp_now() const;

 private:
  bool is_simulated_;
  bool has_ticked_ = false;
  Clock::time_point base_ = Clock::now();  ///< when /clock had `first_`
  std::int64_t first_ = 0, time_ = 0;      ///< [ns]
};

}  // namespace chicane::ros
