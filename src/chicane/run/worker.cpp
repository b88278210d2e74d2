// SPDX-License-Identifier: MIT
// Thread of low priority that does its work each time it is woken, or its period has passed.
#include "chicane/run/worker.hpp"

#include <sys/resource.h>

namespace chicane::run {

Worker::Worker(std::function<void()> work, Period period)
    : work_{std::move(work)}, period_{period}, thread_{[this] { run(); }} {}

Worker::~Worker() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void Worker::wake() {
  {
    const std::lock_guard lock(mutex_);
    is_awake_ = true;
  }
  changed_.notify_one();
}

void Worker::run() {
  // Nice value of the thread. On a busy core Linux gives it a tenth of the time of a thread of nice value 0.
  constexpr int kLowPriority = 10;
  static_cast<void>(setpriority(PRIO_PROCESS, 0, kLowPriority));  // on Linux: of this thread only
  std::unique_lock lock(mutex_);
  const auto is_due = [this] { return is_awake_ || is_ending_; };
  for (;;) {
    if (period_)
      changed_.wait_for(lock, *period_, is_due);
    else
      changed_.wait(lock, is_due);
    if (is_ending_) return;
    is_awake_ = false;
    lock.unlock();
    work_();
    lock.lock();
  }
}

}  // namespace chicane::run
