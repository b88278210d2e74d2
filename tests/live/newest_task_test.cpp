// SPDX-License-Identifier: MIT
#include "chicane/live/newest_task.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

namespace chicane::live {
namespace {

using Task = NewestTask<int, std::string>;

std::string awaited(Task& task) {
  for (;;) {
    if (auto answer = task.take()) return *answer;
    std::this_thread::yield();
  }
}

TEST(NewestTask, AnswersAWishOnce) {
  std::atomic<int> told{0};
  Task task([](int wish, const auto& is_wanted) { return is_wanted() ? std::to_string(wish) : "late"; },
            [&](const std::string& answer) { told += answer == "7" ? 1 : 100; });
  EXPECT_FALSE(task.take());
  EXPECT_FALSE(task.is_computing());
  task.begin(7);
  EXPECT_EQ(awaited(task), "7");
  EXPECT_FALSE(task.take());
  EXPECT_FALSE(task.is_computing());
  EXPECT_EQ(told, 1);
}

TEST(NewestTask, DoesNotHoldUpWhoeverWishesAndKeepsTheLastOfQuickWishes) {
  std::atomic<int> begun{0};
  std::atomic<bool> is_open{false};
  std::vector<std::string> told;
  Task task(
      [&](int wish, const auto& is_wanted) {
        ++begun;
        while (!is_open) std::this_thread::yield();
        return std::to_string(wish) + (is_wanted() ? "" : " too late");
      },
      [&](const std::string& answer) { told.push_back(answer); });
  task.begin(1);
  while (begun == 0) std::this_thread::yield();
  task.begin(2);  // comes back although nothing is computed
  task.begin(3);
  EXPECT_FALSE(task.take());
  EXPECT_TRUE(task.is_computing());
  is_open = true;
  EXPECT_EQ(awaited(task), "3");
  EXPECT_EQ(begun, 2) << "one that waited was replaced";
  EXPECT_EQ(told, std::vector<std::string>{"3"}) << "the first is thrown away";
}

TEST(NewestTask, GivesUpWhatIsCancelledAndSaysNothingOfIt) {
  std::atomic<bool> has_begun{false}, is_told{false};
  {
    Task task(
        [&](int, const auto& is_wanted) {
          has_begun = true;
          while (is_wanted()) std::this_thread::yield();
          return std::string("given up");
        },
        [&](const std::string&) { is_told = true; });
    task.begin(1);
    while (!has_begun) std::this_thread::yield();
    task.cancel();
    EXPECT_FALSE(task.is_computing());
    task.begin(2);  // given up by the destructor
  }
  EXPECT_FALSE(is_told);
}

}  // namespace
}  // namespace chicane::live
