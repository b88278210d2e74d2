// SPDX-License-Identifier: MIT
#include "chicane/live/run_log.hpp"

#include <thread>

#include "support/alloc_guard.hpp"
#include "support/chicane_test.hpp"
#include "support/runs.hpp"

namespace chicane::live {
namespace {

using recording::BranchReport;

std::unique_ptr<run::ClosedLoop> loop_on(const std::string& track) {
  return test::loop_of(
      test::scenario_of({{"laps", "0"}, {"sensor.position_noise_m", "0.05"}, {"track", track}}));
}

/// A run whose log is kept.
class Driven {
 public:
  Driven() { log.begin(loop->scenario()); }
  void drive(int cycles, double budget = 0.0) {
    test::drive_cycles(
        *loop, cycles, [this](const telemetry::Frame& frame) { log.note(frame); }, budget);
    while (!loop->is_control_due()) static_cast<void>(loop->advance());
  }
  void change(std::string_view name, std::string_view value) {
    const telemetry::Change change{
        .cycle = loop->cycle(), .time = loop->time(), .name = name, .value = value};
    loop->apply(change);
    log.note(change);
  }
  Result<BranchReport> branch(const recording::BranchOptions& options) { return log.branch(options, {}); }

  std::unique_ptr<run::ClosedLoop> loop = loop_on("lakeside");
  RunLog log{false};
};

TEST(RunLog, KnowsARunWellEnoughToComputeItAgainBitForBit) {
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
  const auto report = test::good(run.branch({.at = 9.0, .duration = 2.0, .drives_both = true}));
  EXPECT_FALSE(report->first_difference) << *report->first_difference;
  EXPECT_EQ(report->steps_before, 225U);
  EXPECT_DOUBLE_EQ(report->known_until, 239 * 0.04);
}

TEST(RunLog, KnowsARunThatStartedAnewFromThereOnWithItsSettings) {
  Driven run;
  run.change("tracking_mpc.speed_limit_mps", "30");
  run.drive(30);
  run.change("tracking_mpc.speed_limit_mps", "9");
  run.change("fault.link_lost", "+600");
  run.drive(30);
  run.loop->restart();
  run.drive(100);
  const auto report = test::good(run.branch({.at = 1.0, .duration = 3.0, .drives_both = true}));
  EXPECT_FALSE(report->first_difference);
  EXPECT_EQ(report->steps_before, 25U);
  EXPECT_LT(report->recorded.top_speed, 10.5);
  EXPECT_GT(report->recorded.top_speed, 3.0) << "the fault of before is over: the car drives";
}

TEST(RunLog, SaysWhyARunIsNotKnown) {
  RunLog log(false, 100);
  ASSERT_FALSE(log.since({}));
  EXPECT_THAT(log.since({}).error().message, HasSubstr("has not begun"));

  const auto loop = loop_on("lakeside");
  log.begin(loop->scenario());
  test::drive_cycles(*loop, 1, [&](const telemetry::Frame& frame) { log.note(frame); });
  for (int i = 0; i < 99; ++i) log.note(telemetry::CompletedLap{});
  EXPECT_TRUE(log.since({}));
  log.note(telemetry::CompletedLap{});
  ASSERT_FALSE(log.since({}));
  EXPECT_THAT(log.since({}).error().message, HasSubstr("too long"));
  log.note(loop->frame());
  EXPECT_TRUE(log.since({})) << "a run that starts anew is known again";
}

TEST(RunLog, AllocatesNothingOnTheControlThread) {
  const auto loop = loop_on("lakeside");
  RunLog log(false);
  log.begin(loop->scenario());
  while (!loop->advance()) {
  }
  const telemetry::Change change{.name = "latency_ms", .value = "60"};
  const test::AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) {
    log.note(loop->frame());
    log.note(change);
  }
  EXPECT_EQ(guard.count(), 0);
}

/// From now on, once a checkpoint is near enough.
recording::BranchReport branch_from_checkpoint(RunLog& log, const recording::BranchOptions& options,
                                               std::uint64_t most_steps) {
  for (;;) {
    const auto report = log.branch(options, {});
    EXPECT_TRUE(report) << report.error().message;
    if (!report || report->steps_before <= most_steps) return report.value_or(recording::BranchReport{});
    std::this_thread::yield();
  }
}

TEST(RunLog, FollowsTheNewestRunAndGoesOnWhereTheStartIsForgottenAndSaysSo) {
  const auto loop =
      test::loop_of(test::scenario_of({{"track", "oval"}, {"laps", "0"}, {"controller", "pid"}}));
  RunLog log(true, 1000);
  const auto drive = [&](int cycles) {
    test::drive_cycles(*loop, cycles, [&](const telemetry::Frame& frame) { log.note(frame); });
  };
  log.begin(test::scenario_of({{"track", "lakeside"}}));
  drive(30);
  loop->restart();
  log.begin(loop->scenario());
  const recording::BranchOptions now{.at = 1e9, .duration = 1.0, .drives_both = true};
  const auto branch = [&](std::uint64_t cycle) {
    const auto report = test::good(log.branch(now, {}));
    EXPECT_EQ(report->cycle, cycle);
    EXPECT_FALSE(report->first_difference);
  };
  drive(500);
  EXPECT_EQ(branch_from_checkpoint(log, now, 260).cycle, 500U);
  loop->restart();
  drive(300);
  branch(300);
  drive(500);
  branch_from_checkpoint(log, now, 260);
  drive(400);
  EXPECT_FALSE(log.since({})) << "the start is forgotten";
  branch(1200);
  EXPECT_THAT(test::refusal_of(log.branch({.at = 1.0, .duration = 1.0, .drives_both = true}, {})),
              HasSubstr("ask for a moment after"));
}

}  // namespace
}  // namespace chicane::live
