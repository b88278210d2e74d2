// SPDX-License-Identifier: MIT
#include "interrupt.hpp"

#include <csignal>
#include <cstdint>
#include <ctime>

#include "chicane/run/plan_cache.hpp"

namespace chicane::apps {
namespace {

// The globals: a signal handler can reach nothing else.
std::atomic<std::atomic<bool>*> wanted{nullptr};
std::atomic<std::int64_t> first_ns{0};  // when the first signal came [ns]; 0: none yet
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free &&
              std::atomic<std::atomic<bool>*>::is_always_lock_free);

/// Time since the machine started [ns]; may be asked in a signal handler, unlike the clocks of C++.
std::int64_t monotonic_ns() {
  std::timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

void interrupt(int signal) {
  const std::int64_t now = monotonic_ns();
  std::int64_t first = 0;
  if (first_ns.compare_exchange_strong(first, now)) {
    if (std::atomic<bool>* flag = wanted.load()) *flag = true;
  } else if (now - first > std::chrono::nanoseconds(kOneInterrupt).count()) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);  // delivered when this handler returns
  }
}

}  // namespace

void let_interrupts_end() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

void catch_interrupts(std::atomic<bool>& flag) {
  wanted = &flag;
  run::stop_planning_by(flag);
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
}

}  // namespace chicane::apps
