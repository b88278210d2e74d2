// SPDX-License-Identifier: MIT
#include "interrupt.hpp"

#include <csignal>

namespace chicane::apps {
namespace {

std::atomic<bool> is_interrupted{false};  // the one global: a signal handler can reach nothing else
static_assert(std::atomic<bool>::is_always_lock_free);

void interrupt(int signal) {
  is_interrupted = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

const std::atomic<bool>& catch_interrupts() {
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  return is_interrupted;
}

}  // namespace chicane::apps
