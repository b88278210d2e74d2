// SPDX-License-Identifier: MIT
#include "chicane/base/deadline.hpp"

#include "chicane/base/duration.hpp"
#include "chicane/base/random.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

TEST(Durations, EmptyAnswersZero) {
  const Durations durations;
  EXPECT_EQ(durations.count(), 0U);
  EXPECT_EQ(durations.max(), 0U);
  EXPECT_EQ(durations.percentile(0.5), 0U);
}

TEST(Durations, OneValueIsEveryPercentile) {
  Durations durations;
  durations.add(12345);
  EXPECT_EQ(durations.percentile(0.01), 12345U);
  EXPECT_EQ(durations.percentile(1.0), 12345U);
  EXPECT_EQ(durations.max(), 12345U);
}

TEST(Durations, SmallValuesAreExact) {
  Durations durations;
  for (std::uint64_t ns = 1; ns <= 10; ++ns) durations.add(ns);
  EXPECT_EQ(durations.percentile(0.5), 5U);
  EXPECT_EQ(durations.percentile(0.9), 9U);
}

TEST(Durations, PercentilesAgreeWithASortedListToOneBin) {
  Random random(3);
  Durations durations;
  std::vector<std::uint64_t> values;
  for (int i = 0; i < 100000; ++i) {
    values.push_back(static_cast<std::uint64_t>(std::pow(10.0, random.uniform(0.0, 10.0))));
    durations.add(values.back());
  }
  std::sort(values.begin(), values.end());
  for (double share : {0.001, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const double exact = static_cast<double>(values[static_cast<std::size_t>(share * 100000.0) - 1]);
    const double got = static_cast<double>(durations.percentile(share));
    EXPECT_GE(got, exact) << share;
    EXPECT_LE(got, exact * (1.0 + 1.0 / 16.0))
        << share;  // 16 bins per octave: the widest is 1/16 of its lower edge
  }
  EXPECT_EQ(durations.percentile(1.0), values.back());
}

TEST(Durations, TakesTheLargestNumberThereIs) {
  Durations durations;
  durations.add(0);
  durations.add(std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(durations.count(), 2U);
  EXPECT_EQ(durations.max(), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(durations.percentile(0.5), 0U);
}

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

TEST(Durations, AreNumbersOfSeconds) {
  EXPECT_EQ(seconds(std::chrono::milliseconds(1500)), 1.5);
  EXPECT_EQ(duration(1.5), std::chrono::milliseconds(1500));
}

}  // namespace
}  // namespace chicane
