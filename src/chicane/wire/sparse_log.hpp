// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

namespace chicane::wire {

/// Lines for the terminal, at a bounded rate whatever a peer sends. One thread.
class SparseLog {
 public:
  explicit SparseLog(std::function<void(std::string_view)> sink) : sink_{std::move(sink)} {}

  void say(std::string_view line) const {
    if (sink_) sink_(line);
  }
  /// At most one line a second; the next one tells how many were held back.
  void complain(std::string_view line) {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::seconds{1}) {
      ++held_back_;
      return;
    }
    last_ = now;
    const int more = std::exchange(held_back_, 0);
    say(more == 0 ? std::string(line) : std::string(line) + " (" + std::to_string(more) + " like it before)");
  }

 private:
  std::function<void(std::string_view)> sink_;
  std::chrono::steady_clock::time_point last_{};
  int held_back_ = 0;
};

}  // namespace chicane::wire
