// SPDX-License-Identifier: MIT
#include "chicane/live/run_follower.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "chicane/protocol/library.hpp"

namespace chicane::live {
namespace {

std::unique_ptr<run::ClosedLoop> oval() {
  const auto scenario =
      protocol::compose({.scenario_file = {}, .settings = {{"track", "oval"}, {"laps", "0"}}});
  EXPECT_TRUE(scenario);
  return std::move(*run::ClosedLoop::create(*scenario));
}

void drive(run::ClosedLoop& loop, Journal& journal, int cycles) {
  for (int done = 0; done < cycles;) {
    if (!loop.advance()) continue;
    journal.note(loop.frame());
    ++done;
    if (done % 1000 == 0) static_cast<void>(journal.oldest());  // or the ring would be full
  }
}

/// From now on, once the follower has come near enough.
recording::BranchReport branch_from_checkpoint(RunFollower& follower, const recording::BranchOptions& options,
                                               std::uint64_t most_steps) {
  for (;;) {
    const auto report = follower.branch(options, {});
    EXPECT_TRUE(report) << report.error().message;
    if (!report || report->steps_before <= most_steps) return report.value_or(recording::BranchReport{});
    std::this_thread::yield();
  }
}

TEST(RunFollower, SparesABranchTheWayFromTheStart) {
  const auto loop = oval();
  Journal journal;
  journal.begin(loop->scenario());
  drive(*loop, journal, 3000);
  RunFollower follower(journal);
  const recording::BranchOptions now{.at = 1e9, .duration = 2.0, .drives_both = true};
  const auto report = branch_from_checkpoint(follower, now, 260);
  EXPECT_FALSE(report.first_difference);
  EXPECT_EQ(report.cycle, 3000U);
  const auto before_any = follower.branch({.at = 0.0, .duration = 2.0, .drives_both = true}, {});
  ASSERT_TRUE(before_any) << before_any.error().message;
  EXPECT_EQ(before_any->cycle, 0U);
}

TEST(RunFollower, BeginsAnewWithTheRun) {
  const auto loop = oval();
  Journal journal;
  journal.begin(loop->scenario());
  RunFollower follower(journal);
  drive(*loop, journal, 1000);
  const recording::BranchOptions now{.at = 1e9, .duration = 1.0, .drives_both = true};
  EXPECT_EQ(branch_from_checkpoint(follower, now, 260).cycle, 1000U);
  loop->restart();
  drive(*loop, journal, 300);
  const auto report = follower.branch(now, {});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->cycle, 300U) << "of the run that was started anew";
  EXPECT_FALSE(report->first_difference);
}

TEST(RunFollower, GoesOnWhereTheStartIsForgottenAndSaysSoOfWhatIs) {
  const auto loop = oval();
  Journal journal;
  journal.begin(loop->scenario());
  drive(*loop, journal, 2000);
  RunFollower follower(journal);
  const recording::BranchOptions now{.at = 1e9, .duration = 1.0, .drives_both = true};
  branch_from_checkpoint(follower, now, 260);
  // Changes are events, too: so many that the steps before a minute ago are forgotten.
  const telemetry::Change change{.cycle = loop->cycle(),
                                 .time = loop->time(),
                                 .name = std::string_view("tracking_mpc.speed_limit_mps"),
                                 .value = std::string_view("20")};
  loop->apply(change);
  for (std::size_t i = 0; i < Journal::kMostEvents - 1000; ++i) {
    journal.note(change);
    if (i % 1000 == 0) static_cast<void>(journal.oldest());
  }
  drive(*loop, journal, 200);
  EXPECT_GT(journal.oldest().event, 0U);
  const auto report = follower.branch(now, {});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_FALSE(report->first_difference);
  EXPECT_EQ(report->cycle, 2200U);
  const auto too_early = follower.branch({.at = 1.0, .duration = 1.0, .drives_both = true}, {});
  ASSERT_FALSE(too_early);
  EXPECT_THAT(too_early.error().message, testing::HasSubstr("ask for a moment after"));
}

}  // namespace
}  // namespace chicane::live
