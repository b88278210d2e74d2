// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

namespace chicane::python {

/// Asks Python for signals (Ctrl-C) while C++ works without the interpreter's lock. One thread.
class SignalWatch {
 public:
  /// Whether the work has to end. Without the lock; takes it 20 times a second at most.
  bool operator()() {
    if (error_) return true;
    const Clock::time_point now = Clock::now();
    if (now < next_) return false;
    next_ = now + kPeriod;
    const pybind11::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) error_ = std::make_unique<pybind11::error_already_set>();
    return error_ != nullptr;
  }
  /// Raises what the signal's handler has raised. With the lock.
  void raise() {
    if (error_) throw pybind11::error_already_set(*std::exchange(error_, nullptr));
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kPeriod{50};

  Clock::time_point next_ = Clock::now() + kPeriod;
  std::unique_ptr<pybind11::error_already_set> error_;
};

/// Runs `work` on a thread of its own, without the interpreter's lock, while this one waits for signals; one
/// sets `stop`, which ends the work. Raises what the signal's handler has raised. With the lock.
inline void run_with_signals(std::atomic<bool>& stop, const std::function<void()>& work) {
  SignalWatch watch;
  {
    const pybind11::gil_scoped_release without_lock;
    std::mutex mutex;
    std::condition_variable ended;
    bool has_ended = false;
    std::jthread thread([&] {
      work();
      const std::lock_guard lock(mutex);
      has_ended = true;
      ended.notify_all();
    });
    std::unique_lock lock(mutex);
    while (!ended.wait_for(lock, std::chrono::milliseconds(20), [&] { return has_ended; })) {
      lock.unlock();
      if (watch()) stop = true;
      lock.lock();
    }
  }
  watch.raise();
}

}  // namespace chicane::python
