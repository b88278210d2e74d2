// SPDX-License-Identifier: MIT
#include "program.hpp"
#include "support/chicane_test.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <thread>

namespace chicane::apps {
namespace {

/// How a process ends that catches interrupts and gets `count` of `signal`, `apart` from each other: its exit
/// code, 0 when it was told to end and 1 when not, or 128 and the signal that ended it.
int end_of_process(int signal, int count, std::chrono::milliseconds apart) {
  const pid_t child = ::fork();
  if (child == 0) {
    static std::atomic<bool> stop{false};
    catch_interrupts(stop);
    for (int i = 0; i < count; ++i) {
      if (i > 0) std::this_thread::sleep_for(apart);
      std::raise(signal);
    }
    ::_exit(stop ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(Interrupt, TheFirstAsksTheRunToEndItself) {
  EXPECT_EQ(end_of_process(SIGINT, 0, {}), 1);
  EXPECT_EQ(end_of_process(SIGINT, 1, {}), 0);
  EXPECT_EQ(end_of_process(SIGTERM, 1, {}), 0);
}

// `timeout -s INT` sends one to its child and one to its group. A loaded machine once ran the child in
// between, where the second ended it before its results were written.
TEST(Interrupt, TwoAtOnceAreOne) {
  EXPECT_EQ(end_of_process(SIGINT, 2, {}), 0);
  EXPECT_EQ(end_of_process(SIGTERM, 2, {}), 0);
}

TEST(Interrupt, AnotherAfterAWhileEndsTheProcess) {
  const auto apart = kOneInterrupt + std::chrono::milliseconds(20);
  EXPECT_EQ(end_of_process(SIGINT, 2, apart), 128 + SIGINT);
  EXPECT_EQ(end_of_process(SIGTERM, 2, apart), 128 + SIGTERM);
}

}  // namespace
}  // namespace chicane::apps
