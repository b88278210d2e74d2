// SPDX-License-Identifier: MIT
#include "chicane/live/worker.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <future>
#include <thread>

namespace chicane::live {
namespace {

using namespace std::chrono_literals;

TEST(Worker, WorksOnceForEachWakeAndNotBefore) {
  std::atomic<int> works{0};
  std::promise<void> began, may_end;
  const std::shared_future<void> end = may_end.get_future().share();
  {
    Worker worker([&] {
      if (++works == 1) began.set_value();
      end.wait();
    });
    EXPECT_EQ(works, 0);
    worker.wake();
    began.get_future().wait();
    worker.wake();  // two during a work lead to one more
    worker.wake();
    may_end.set_value();
    while (works < 2) std::this_thread::yield();
  }
  EXPECT_EQ(works, 2);
}

TEST(Worker, WorksEachPeriodUntilItIsDestroyed) {
  std::atomic<int> works{0};
  {
    const Worker worker([&] { ++works; }, 1ms);
    while (works < 3) std::this_thread::yield();
  }
  const int at_end = works;
  std::this_thread::sleep_for(5ms);
  EXPECT_EQ(works, at_end);
}

TEST(Worker, IsBehindTheThreadThatMakesIt) {
  std::promise<int> nice;
  Worker worker([&] { nice.set_value(::getpriority(PRIO_PROCESS, 0)); });
  worker.wake();
  EXPECT_GE(nice.get_future().get(), 10);
}

TEST(Worker, WaitsForAWorkUnderWay) {
  std::promise<void> began;
  bool has_ended = false;
  {
    Worker worker([&] {
      began.set_value();
      std::this_thread::sleep_for(20ms);
      has_ended = true;
    });
    worker.wake();
    began.get_future().wait();
  }
  EXPECT_TRUE(has_ended);
}

}  // namespace
}  // namespace chicane::live
