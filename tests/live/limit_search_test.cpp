// SPDX-License-Identifier: MIT
#include "chicane/live/limit_search.hpp"

#include <gtest/gtest.h>

#include <future>

#include "chicane/road/track.hpp"
#include "chicane/run/make.hpp"

namespace chicane::live {
namespace {

using Answer = Result<std::shared_ptr<const lap_time::Limit>>;

TEST(LimitSearch, AnswersOnceAndHasEnded) {
  const scenario::Scenario scenario;
  const auto track = run::make_track(scenario);
  ASSERT_TRUE(track);
  std::promise<Answer> found;
  int answers = 0;
  LimitSearch search(*track, scenario, [&](Answer answer) {
    ++answers;
    found.set_value(std::move(answer));
  });
  const Answer answer = found.get_future().get();
  ASSERT_TRUE(answer) << answer.error().message;
  EXPECT_NEAR((*answer)->times.lap, 22.83, 0.05);  // docs/limit.md, table 1: lakeside
  EXPECT_DOUBLE_EQ((*answer)->line.back().time, (*answer)->times.lap);
  while (!search.has_ended()) std::this_thread::yield();
  search.cancel();
  EXPECT_EQ(answers, 1);
}

TEST(LimitSearch, SaysNothingOnceItIsCancelled) {
  const scenario::Scenario scenario;
  const auto track = run::make_track(scenario);
  ASSERT_TRUE(track);
  std::atomic<bool> is_cancelled{false};
  bool came_late = false;
  {
    LimitSearch search(*track, scenario, [&](const Answer&) { came_late = is_cancelled; });
    search.cancel();
    is_cancelled = true;
  }
  EXPECT_FALSE(came_late);
}

}  // namespace
}  // namespace chicane::live
