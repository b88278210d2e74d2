// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace chicane::wire {

/// Lines for the terminal, at a bounded rate whatever a peer sends. One thread.
class SparseLog {
 public:
  explicit SparseLog(std::function<void(std::string_view)> sink) : sink_{std::move(sink)} {}

  void say(std::string_view line) const {
    if (sink_) sink_(line);
  }

  /// At most once a second the same line; the next one tells how many were held back. A line unlike the last
  /// few ones comes at once: kNewLines of them, and then one a second.
  void complain(std::string_view line) {
    const Clock::time_point now = Clock::now();
    const auto known =
        std::find_if(said_.begin(), said_.end(), [&](const Said& each) { return each.line == line; });
    if (known == said_.end()) return say_new(line, now);
    if (now - known->at < kPause) {
      ++known->held_back;
      return;
    }
    known->at = now;
    const int more = std::exchange(known->held_back, 0);
    say(more == 0 ? std::string(line) : std::string(line) + " (" + std::to_string(more) + " like it before)");
  }

  /// `line`, unless one of the same reason was said before. After kReasons of them: nothing more.
  void say_once(std::string_view reason, std::string_view line) {
    if (reasons_.size() == kReasons || std::find(reasons_.begin(), reasons_.end(), reason) != reasons_.end())
      return;
    reasons_.emplace_back(reason);
    say(line);
  }

  static constexpr std::size_t kRemembered = 8;
  static constexpr int kNewLines = 4;
  static constexpr std::size_t kReasons = 32;

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kPause{1};
  struct Said {
    std::string line;
    Clock::time_point at{};
    int held_back = 0;
  };

  void say_new(std::string_view line, Clock::time_point now) {
    const double pause = std::chrono::duration<double>(now - refilled_) / kPause;
    budget_ = std::min(double{kNewLines}, budget_ + pause);
    refilled_ = now;
    if (budget_ < 1.0) return;
    budget_ -= 1.0;
    if (said_.size() == kRemembered) said_.pop_front();
    said_.push_back({std::string(line), now});
    say(line);
  }

  std::function<void(std::string_view)> sink_;
  std::deque<Said> said_;
  std::vector<std::string> reasons_;
  Clock::time_point refilled_{};
  double budget_ = kNewLines;
};

}  // namespace chicane::wire
