// SPDX-License-Identifier: MIT
#include "interrupt.hpp"

#include <csignal>

namespace chicane::apps {
namespace {

std::atomic<std::atomic<bool>*> wanted{nullptr};  // the one global: a signal handler can reach nothing else
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::atomic<bool>*>::is_always_lock_free);

void interrupt(int signal) {
  if (std::atomic<bool>* flag = wanted.load()) *flag = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_interrupts(std::atomic<bool>& flag) {
  wanted = &flag;
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
}

}  // namespace chicane::apps
