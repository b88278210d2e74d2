// SPDX-License-Identifier: MIT
#include "progress.hpp"

#include "apps/program_outcome.hpp"
#include "experiment.hpp"
#include "support/chicane_test.hpp"

namespace chicane::apps {
namespace {

using controller::GuardReason;
using controller::Rung;

constexpr double kPeriod = 0.04;  // [s]

telemetry::Frame driving() {
  telemetry::Frame frame;
  frame.measurement.speed = 20.0;
  frame.applied.throttle = 0.3;
  return frame;
}

telemetry::Frame stopped_by_guard() {
  telemetry::Frame frame = driving();
  frame.guard.rung = Rung::kGuardStop;
  frame.guard.reason = GuardReason::kNoWayToStop;
  return frame;
}

telemetry::Frame standing(double throttle) {
  telemetry::Frame frame = driving();
  frame.measurement.speed = 0.0;
  frame.applied.throttle = throttle;
  return frame;
}

/// A run and what is said of it.
struct Watched {
  RunNotices notices;
  telemetry::Situation situation;
  double time = 0.0;  ///< [s]
  std::vector<std::string> said;

  /// Shows the same frame for so many seconds.
  void see(telemetry::Frame frame, double seconds) {
    for (const double end = time + seconds - 0.5 * kPeriod; time < end; time += kPeriod) {
      frame.time = time;
      frame.situation = situation = telemetry::situation_of(frame, situation, {});
      for (std::string& line : notices.look_at(frame)) said.push_back(std::move(line));
    }
  }
};

TEST(RunNotices, SayWhenAnInterventionBeginsWhyAndHowLongItWas) {
  Watched run;
  run.see(driving(), 4.0);
  EXPECT_THAT(run.said, IsEmpty());
  run.see(stopped_by_guard(), kPeriod);
  EXPECT_THAT(run.said, ElementsAre("4.0 s: The guard stops the car: the controller's command "
                                    "would leave no way to stop on the road"));
  run.see(stopped_by_guard(), 0.4 - kPeriod);
  run.see(driving(), 2.0);
  ASSERT_EQ(run.said.size(), 2U);
  EXPECT_EQ(run.said[1], "4.4 s: the controller drives again, after 0.4 s and 10 replaced commands");
}

TEST(RunNotices, AreTwoLinesForAnInterventionThatComesAndGoes) {
  Watched run;
  for (int i = 0; i < 50; ++i) {
    run.see(stopped_by_guard(), kPeriod);
    run.see(driving(), 0.2);
  }
  run.see(driving(), 2.0);
  ASSERT_EQ(run.said.size(), 2U);
  EXPECT_THAT(run.said[1], HasSubstr("50 replaced commands"));
}

TEST(RunNotices, SayAnotherReasonOnceASecond) {
  Watched run;
  telemetry::Frame other = stopped_by_guard();
  other.guard.reason = GuardReason::kPositionJump;
  run.see(stopped_by_guard(), 0.5);
  run.see(other, 0.4);
  EXPECT_EQ(run.said.size(), 1U);
  run.see(other, 0.4);
  ASSERT_EQ(run.said.size(), 2U);
  EXPECT_THAT(run.said[1], HasSubstr("the measured position changed faster than a car can move"));
}

TEST(RunNotices, SayOnceThatTheCarStandsAndThatItMovesAgain) {
  Watched run;
  run.see(driving(), 1.0);
  run.see(standing(0.0), 2.9);
  EXPECT_THAT(run.said, IsEmpty());
  run.see(standing(0.0), 9.0);
  EXPECT_THAT(run.said,
              ElementsAre("4.0 s: The car stands and should drive: the controller gives no throttle. It ends "
                          "when the car moves. On the dashboard, M takes the wheel and R starts again."));
  run.see(driving(), 5.0);
  ASSERT_EQ(run.said.size(), 2U);
  EXPECT_THAT(run.said[1], HasSubstr("the car moves again, after 8.9 s"));
}

TEST(RunNotices, SayOneSentenceOnceOfAStopAndWhatEndsIt) {
  Watched run;
  telemetry::Frame frame = stopped_by_guard();
  frame.guard.reason = GuardReason::kPositionJump;
  run.see(frame, 2.0);
  frame.measurement.speed = 0.0;
  run.see(frame, 20.0);
  EXPECT_THAT(run.said,
              ElementsAre(HasSubstr("The guard stops the car: the measured position changed"),
                          HasSubstr("The guard holds the car. It ends when the measurements agree, or "
                                    "answer a trial of half a metre. On the dashboard, M takes")));
}

TEST(RunNotices, SayNothingOfACarThatAPersonLetsStand) {
  Watched run;
  telemetry::Frame manual = standing(0.0);
  manual.is_manual = true;
  run.see(manual, 9.0);
  EXPECT_THAT(run.said, IsEmpty());
}

TEST(RunNotices, BeginAnewWithAnotherRun) {
  Watched run;
  run.see(standing(0.0), 2.0);
  run.time = 0.0;
  run.see(standing(0.0), 2.0);
  EXPECT_THAT(run.said, IsEmpty());
}

TEST(PlanLine, SaysHowFarItIsAndWhatIsLeft) {
  const lap_time::PlanProgress half{.work = 5.0, .expected = 10.0};
  EXPECT_EQ(plan_line(half, 8.0, 90.0), "planning the lap: 50 %, about 8 s left");
  const lap_time::PlanProgress late{.work = 60.0, .expected = 10.0};
  EXPECT_EQ(plan_line(late, 120.0, 90.0), "planning the lap: 120 s so far, at most 60 s left");
}

TEST(RunNotices, ComeWhenItHappensAndBesideTheResults) {
  const test::Outcome lost = test::chicane_program(
      "drive --fast --json --laps 1 --set time_limit_s=20 --set guard.blind_time_s=1 --fault link_lost@8+9");
  EXPECT_THAT(lost.out, StartsWith("{"));
  EXPECT_THAT(lost.out, Not(HasSubstr("The guard stops")));
  EXPECT_THAT(lost.err, HasSubstr("position, yaw or speed has not been measured for too long"));
  EXPECT_THAT(lost.err,
              HasSubstr("The guard holds the car. It ends when the measurements are right again. "));
  EXPECT_THAT(lost.err, HasSubstr("the controller drives again, after "));
}

using safety::GuardMode;
using ::testing::Eq;

/// Text of a short run on stderr.
std::string said_by_drive(const std::string& options) {
  return test::chicane_program("drive --fast --laps 1 --set time_limit_s=0.2 " + options).err;
}

TEST(GuardNotice, SaysWhatTheOptionsLeaveOpen) {
  EXPECT_EQ(guard_notice({}), "");
  EXPECT_THAT(guard_notice({.mode = GuardMode::kOff}), StartsWith("guard.mode=off: "));
  EXPECT_THAT(guard_notice({.mode = GuardMode::kObserve, .blind_time = 0.0}),
              StartsWith("guard.mode=observe: "));
  EXPECT_THAT(guard_notice({.blind_time = 0.0}), StartsWith("guard.blind_time_s=0: "));
}

TEST(GuardNotice, IsOneLineAtTheStartOfARunButNotBesideJson) {
  EXPECT_THAT(said_by_drive("--set guard.mode=off"), Eq(guard_notice({.mode = GuardMode::kOff}) + "\n"));
  EXPECT_THAT(said_by_drive("--set guard.blind_time_s=0"), Eq(guard_notice({.blind_time = 0.0}) + "\n"));
  EXPECT_EQ(said_by_drive(""), "");
  EXPECT_EQ(said_by_drive("--set guard.mode=off --json"), "");
}

}  // namespace
}  // namespace chicane::apps
