// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

namespace chicane::python {

/// Ends a call of Python code that takes too long: raises TimeoutError in the thread that runs it, as soon as
/// that executes Python again.
///
/// begin() and end() belong to the thread of the calls, which holds the interpreter's lock. The destructor is
/// called without the lock.
class StepWatch {
 public:
  /// `limit` [s] of a call by the wall clock; 0: none.
  explicit StepWatch(double limit) : limit_{limit} {
    if (limit > 0.0) thread_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
  }

  void begin() {
    const std::lock_guard lock(mutex_);
    began_ = Clock::now();
    thread_id_ = PyThread_get_thread_ident();
    has_fired_ = false;
  }
  /// True when the call was ended by this watch.
  bool end() {
    const std::lock_guard lock(mutex_);
    began_.reset();
    if (has_fired_) PyThreadState_SetAsyncExc(thread_id_, nullptr);  // where it came too late for the call
    return has_fired_;
  }

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] bool is_late() const {
    return began_ && !has_fired_ && std::chrono::duration<double>(Clock::now() - *began_).count() > limit_;
  }
  void watch(const std::stop_token& stop) {
    std::condition_variable_any wake;
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
      wake.wait_for(lock, stop, std::chrono::milliseconds(20), [] { return false; });
      if (!is_late()) continue;
      lock.unlock();
      {
        const pybind11::gil_scoped_acquire interpreter;
        const std::lock_guard again(mutex_);
        if (is_late()) {
          PyThreadState_SetAsyncExc(thread_id_, PyExc_TimeoutError);
          has_fired_ = true;
        }
      }
      lock.lock();
    }
  }

  double limit_;
  std::mutex mutex_;
  std::optional<Clock::time_point> began_;
  unsigned long thread_id_ = 0;
  bool has_fired_ = false;
  std::jthread thread_;  // last: it starts when everything else is there
};

}  // namespace chicane::python
