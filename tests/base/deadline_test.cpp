// SPDX-License-Identifier: MIT
#include "chicane/base/deadline.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

TEST(Deadline, CountsTheQuestionsOfAllItsCopies) {
  DeadlineLog log;
  const Deadline deadline = Deadline::never().counted_in(log);
  const Deadline copy = deadline;
  EXPECT_FALSE(deadline.spent());
  EXPECT_FALSE(copy.spent());
  EXPECT_EQ(log.asked, 2U);
  EXPECT_EQ(log.spent_at, 0U);
}

TEST(Deadline, RemembersTheQuestionThatFoundItSpent) {
  DeadlineLog log;
  const Deadline spent = Deadline::after(std::chrono::nanoseconds{0}).counted_in(log);
  EXPECT_TRUE(spent.spent());
  EXPECT_TRUE(spent.spent());
  EXPECT_EQ(log.spent_at, 1U);
}

TEST(Deadline, AnswersAgainAsItWasLoggedWhateverTheClockSays) {
  DeadlineLog log{.spent_at = 3};
  const Deadline again = Deadline::never().counted_in(log);
  EXPECT_FALSE(again.spent());
  EXPECT_FALSE(again.spent());
  EXPECT_TRUE(again.spent());
  EXPECT_TRUE(again.spent());
  EXPECT_EQ(log.spent_at, 3U);
}

}  // namespace
}  // namespace chicane
