// SPDX-License-Identifier: MIT
#include "chicane/run/worker.hpp"
#include "support/chicane_test.hpp"

#include <atomic>
#include <future>
#include <thread>

namespace chicane::run {
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

}  // namespace
}  // namespace chicane::run
