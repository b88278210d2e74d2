// SPDX-License-Identifier: MIT
#include "chicane/live/journal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "chicane/protocol/library.hpp"
#include "chicane/run/closed_loop.hpp"
#include "support/alloc_guard.hpp"

namespace chicane::live {
namespace {

using recording::BranchReport;
using testing::HasSubstr;

std::unique_ptr<run::ClosedLoop> loop_of(
    const std::vector<std::pair<std::string, std::string>>& settings = {}) {
  std::vector<std::pair<std::string, std::string>> all{{"laps", "0"}, {"sensor.position_noise_m", "0.05"}};
  all.insert(all.end(), settings.begin(), settings.end());
  const auto scenario = protocol::compose({.scenario_file = {}, .settings = all});
  EXPECT_TRUE(scenario);
  return std::move(*run::ClosedLoop::create(*scenario));
}

/// A run whose journal is kept.
class Driven {
 public:
  Driven() { journal.begin(loop->scenario()); }
  void drive(int cycles, double budget = 0.0) {
    for (int done = 0; done < cycles;) {
      if (!loop->advance(budget)) continue;
      journal.note(loop->frame());
      ++done;
    }
    while (!loop->is_control_due()) static_cast<void>(loop->advance());
  }
  void change(std::string_view name, std::string_view value) {
    const telemetry::Change change{
        .cycle = loop->cycle(), .time = loop->time(), .name = name, .value = value};
    loop->apply(change);
    journal.note(change);
  }
  Result<BranchReport> branch(const recording::BranchOptions& options) {
    const auto events = journal.history();
    if (!events) return fail(events.error());
    return recording::branch_run(events->events, options, {});
  }

  std::unique_ptr<run::ClosedLoop> loop = loop_of();
  Journal journal;
};

TEST(Journal, KnowsARunWellEnoughToComputeItAgainBitForBit) {
  Driven run;
  run.drive(60);
  run.change("tracking_mpc.speed_limit_mps", "12");
  run.change("fault.half_grip", "+1*0.4");
  run.drive(100, 1e-5);  // the clock ends the solver before it is done
  run.change("manual.is_on", "true");
  run.change("manual.steer", "0.1");
  run.drive(20);
  run.change("manual.is_on", "false");
  run.drive(60);
  const auto report = run.branch({.at = 9.0, .duration = 2.0, .drives_both = true});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_FALSE(report->first_difference) << *report->first_difference;
  EXPECT_EQ(report->steps_before, 225U);
  EXPECT_DOUBLE_EQ(report->known_until, 239 * 0.04);
}

TEST(Journal, KnowsARunThatStartedAnewFromThereOnWithItsSettings) {
  Driven run;
  run.change("tracking_mpc.speed_limit_mps", "30");
  run.drive(30);
  run.change("tracking_mpc.speed_limit_mps", "9");
  run.change("fault.link_lost", "+600");
  run.drive(30);
  run.loop->restart();
  run.drive(100);
  const auto report = run.branch({.at = 1.0, .duration = 3.0, .drives_both = true});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_FALSE(report->first_difference);
  EXPECT_EQ(report->steps_before, 25U);
  EXPECT_LT(report->recorded.top_speed, 10.5);
  EXPECT_GT(report->recorded.top_speed, 3.0) << "the fault of before is over: the car drives";
}

TEST(Journal, KnowsTheNewestRunOnly) {
  Driven run;
  run.drive(30);
  run.loop = loop_of({{"track", "oval"}});
  run.journal.begin(run.loop->scenario());
  run.drive(50);
  const auto report = run.branch({.at = 1.0, .duration = 1.0, .drives_both = true});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_FALSE(report->first_difference);
  EXPECT_EQ(report->cycle, 25U);
}

TEST(Journal, SaysWhyARunIsNotKnown) {
  Journal journal;
  ASSERT_FALSE(journal.history());
  EXPECT_THAT(journal.history().error().message, HasSubstr("has not begun"));

  const auto loop = loop_of();
  journal.begin(loop->scenario());
  while (!loop->advance()) {
  }
  telemetry::Frame frame = loop->frame();
  for (std::size_t i = 0; i <= Journal::kMostEvents; i += 1000) {
    for (std::size_t k = 0; k < 1000; ++k) {
      journal.note(frame);
      frame.begins = false;
    }
    static_cast<void>(journal.history());  // collects
  }
  journal.note(frame);
  ASSERT_FALSE(journal.history());
  EXPECT_THAT(journal.history().error().message, HasSubstr("too long"));
  frame.begins = true;
  journal.note(frame);
  EXPECT_TRUE(journal.history()) << "a run that starts anew is known again";
}

TEST(Journal, AllocatesNothingOnTheControlThread) {
  const auto loop = loop_of();
  Journal journal;
  journal.begin(loop->scenario());
  while (!loop->advance()) {
  }
  const telemetry::Change change{.name = "latency_ms", .value = "60"};
  const test::AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) {
    journal.note(loop->frame());
    journal.note(change);
  }
  EXPECT_EQ(guard.count(), 0);
}

}  // namespace
}  // namespace chicane::live
