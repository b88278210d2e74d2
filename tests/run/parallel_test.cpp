// SPDX-License-Identifier: MIT
#include "chicane/run/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace chicane::run {
namespace {

TEST(Parallel, DoesEachOnceOnAnyNumberOfThreads) {
  for (const int jobs : {1, 2, 7}) {
    std::vector<std::atomic<int>> done(100);
    for_each_run(done.size(), jobs, [&](std::uint64_t i, Roads&) {
      ++done[i];
      return true;
    });
    for (const auto& each : done) EXPECT_EQ(each, 1);
  }
}

TEST(Parallel, EndsWhenAWorkSaysSo) {
  int done = 0;
  for_each_run(100, 1, [&](std::uint64_t, Roads&) { return ++done < 5; });
  EXPECT_EQ(done, 5);
  EXPECT_GE(threads_for(0), 1);
  EXPECT_EQ(threads_for(3), 3);
}

}  // namespace
}  // namespace chicane::run
