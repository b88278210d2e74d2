// SPDX-License-Identifier: MIT
#include "chicane/run/parallel.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>

#include "chicane/telemetry/metrics.hpp"

namespace chicane::run {
namespace {

using ChangeQueue = ThreadQueue<telemetry::Change>;

telemetry::Change change(std::uint64_t number) {
  return {.cycle = number, .name = "run.pace", .value = std::to_string(number)};
}

TEST(ThreadQueue, LosesNothingBetweenTwoThreads) {
  constexpr std::uint64_t kCount = 5000;
  const auto queue = std::make_unique<ChangeQueue>();
  std::thread sender{[&] {
    for (std::uint64_t i = 0; i < kCount;) i += queue->push(change(i)) ? 1 : 0;
  }};
  for (std::uint64_t i = 0; i < kCount;) {
    const telemetry::Change* next = queue->front();
    if (next == nullptr) continue;
    EXPECT_EQ(next->cycle, i);
    EXPECT_EQ(next->value.view(), std::to_string(i));
    queue->pop();
    ++i;
  }
  sender.join();
}

}  // namespace
}  // namespace chicane::run
