// SPDX-License-Identifier: MIT
#include "chicane/run/parallel.hpp"

#include <thread>

#include "chicane/telemetry/metrics.hpp"
#include "support/chicane_test.hpp"

namespace chicane::run {
namespace {

using ChangeQueue = ThreadQueue<telemetry::Change>;

telemetry::Change change(std::uint64_t number) {
  return {.cycle = number, .name = "run.pace", .value = std::to_string(number)};
}

TEST(ThreadQueue, GivesChangesInTheirOrder) {
  const auto queue = std::make_unique<ChangeQueue>();
  EXPECT_EQ(queue->front(), nullptr);
  EXPECT_TRUE(queue->push(change(1)));
  EXPECT_TRUE(queue->push(change(2)));
  ASSERT_NE(queue->front(), nullptr);
  EXPECT_EQ(queue->front()->value.view(), "1");
  queue->pop();
  EXPECT_EQ(queue->front()->value.view(), "2");
  queue->pop();
  EXPECT_EQ(queue->front(), nullptr);
}

TEST(ThreadQueue, RefusesWhatDoesNotFitAndKeepsTheRest) {
  const auto queue = std::make_unique<ChangeQueue>();
  for (std::uint64_t i = 0; i < ChangeQueue::kCapacity; ++i) {
    EXPECT_EQ(queue->room(), ChangeQueue::kCapacity - i);
    EXPECT_TRUE(queue->push(change(i)));
  }
  EXPECT_FALSE(queue->push(change(999)));
  EXPECT_EQ(queue->front()->cycle, 0u);
  queue->pop();
  EXPECT_EQ(queue->room(), 1u);
  EXPECT_TRUE(queue->push(change(1000)));
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
