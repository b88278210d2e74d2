// SPDX-License-Identifier: MIT
#pragma once

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

namespace chicane::python {

/// Threads that wait between jobs, as starting one takes longer than a step of an environment. The caller's
/// is one of them. Works in a process that was forked, too: there it starts threads anew.
class Crew {
 public:
  /// 0 threads: as many as there are processors.
  explicit Crew(int threads)
      : count_{threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()))} {}
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;
  ~Crew() { end(); }

  [[nodiscard]] int threads() const noexcept { return count_; }

  /// Calls work(i) for each i < jobs, each on any thread, and returns when all are done. `work` throws
  /// nothing.
  void run(std::size_t jobs, const std::function<void(std::size_t)>& work) {
    const int helpers = static_cast<int>(std::min(static_cast<std::size_t>(count_), jobs)) - 1;
    if (helpers <= 0) {
      for (std::size_t i = 0; i < jobs; ++i) work(i);
      return;
    }
    if (process_ != getpid()) begin();
    work_ = &work;
    jobs_ = jobs;
    next_ = 0;
    busy_ = static_cast<int>(others_.size());
    ++round_;
    round_.notify_all();
    take_jobs();
    for (int busy = busy_; busy != 0; busy = busy_) await_change(busy_, busy);
  }

 private:
  static constexpr int kSpins = 2000;  ///< some 30 µs, before a thread goes to sleep

  static void await_change(const std::atomic<int>& number, int from) {
    for (int n = 0; n < kSpins; ++n) {
      if (number != from) return;
      pause();
    }
    number.wait(from);
  }
  static void pause() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
  }
  void begin() {
    end();
    process_ = getpid();
    for (int n = 1; n < count_; ++n) others_.emplace_back([this, from = round_.load()] { live(from); });
  }
  void end() {
    if (process_ == getpid()) {
      has_ended_ = true;
      ++round_;
      round_.notify_all();
      for (std::thread& thread : others_) thread.join();
      has_ended_ = false;
    } else {  // the threads stayed in the other process
      for (std::thread& thread : others_) thread.detach();
    }
    others_.clear();
  }
  void live(int round) {
    while (true) {
      while (round_ == round) await_change(round_, round);
      round = round_;
      if (has_ended_) return;
      take_jobs();
      if (--busy_ == 0) busy_.notify_all();
    }
  }
  void take_jobs() {
    for (std::size_t i = next_++; i < jobs_; i = next_++) (*work_)(i);
  }

  const int count_;
  pid_t process_ = -1;  ///< owner of the threads: a copy by fork has none
  std::vector<std::thread> others_;
  std::atomic<int> round_{0};
  std::atomic<int> busy_{0};
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> has_ended_{false};
  const std::function<void(std::size_t)>* work_ = nullptr;
  std::size_t jobs_ = 0;
};

}  // namespace chicane::python
