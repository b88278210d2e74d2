// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

namespace chicane::live {

/// A thread beside a run that does one kind of work again and again, behind everything else: control and
/// network never wait for it.
class Worker {
 public:
  using Period = std::optional<std::chrono::milliseconds>;

  /// `work` is called on the thread: after each wake(), and each `period` where there is one. Several calls
  /// of wake() during a work lead to one more. Owners keep a Worker as their last member: its thread uses
  /// the others.
  explicit Worker(std::function<void()> work, Period period = {});
  /// Waits for a work under way: owners end a long one before.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Any thread. Does not wait.
  void wake();

 private:
  void run();

  std::function<void()> work_;
  Period period_;
  std::mutex mutex_;  ///< of all below
  std::condition_variable changed_;
  bool is_awake_ = false;
  bool is_ending_ = false;
  std::thread thread_;  // last: it starts when everything else is there
};

}  // namespace chicane::live
