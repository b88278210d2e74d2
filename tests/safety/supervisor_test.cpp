// SPDX-License-Identifier: MIT
#include "chicane/safety/supervisor.hpp"

#include <gtest/gtest.h>

namespace chicane::safety {
namespace {

using enum controller::GuardReason;

/// Judges `findings` each 40 ms for `seconds`; the last verdict.
Supervisor::Verdict after(Supervisor& supervisor, const Findings& findings, double& time, double seconds,
                          double speed = 20.0) {
  Supervisor::Verdict verdict;
  bool may_begin_anew = false;
  for (const double end = time + seconds; time < end; time += 0.04) {
    verdict = supervisor.judge(findings, time, speed);
    may_begin_anew |= verdict.may_begin_anew;
  }
  verdict.may_begin_anew = may_begin_anew;
  return verdict;
}

TEST(Supervisor, ToleratesWhatIsShortAndStopsForWhatLasts) {
  struct Case {
    Findings findings;
    controller::GuardReason reason;
    double tolerated;
  };
  const Case cases[] = {{{.unmeasured = true}, kNotMeasured, Supervisor::kUnmeasured},
                        {{.speed_mismatch = true}, kSpeedMismatch, Supervisor::kTolerated},
                        {{.heading_jump = true}, kHeadingJump, Supervisor::kTolerated},
                        {{.position_jump = true}, kPositionJump, Supervisor::kTolerated}};
  for (const Case& each : cases) {
    Supervisor supervisor;
    double time = 10.0;
    EXPECT_FALSE(after(supervisor, {}, time, 1.0).must_stop);
    EXPECT_FALSE(after(supervisor, each.findings, time, each.tolerated - 0.04).must_stop);
    const Supervisor::Verdict verdict = after(supervisor, each.findings, time, 0.16);
    EXPECT_TRUE(verdict.must_stop);
    EXPECT_EQ(verdict.reason, each.reason);
    EXPECT_FALSE(after(supervisor, {}, time, 0.05).must_stop) << "it ends by itself";
  }
}

TEST(Supervisor, StopsAtOnceForAFrozenSensor) {
  Supervisor supervisor;
  EXPECT_TRUE(supervisor.judge({.frozen = true}, 5.0, 20.0).must_stop);
}

TEST(Supervisor, NamesTheWorstCondition) {
  Supervisor supervisor;
  double time = 0.0;
  EXPECT_EQ(after(supervisor, {.unmeasured = true, .position_jump = true}, time, 1.0).reason, kPositionJump);
}

TEST(Supervisor, BelievesASpeedAnewOnceWhenTheCarHasStood) {
  Supervisor supervisor;
  double time = 0.0;
  const Findings wrong{.speed_mismatch = true};
  EXPECT_FALSE(after(supervisor, wrong, time, 20.0, 5.0).may_begin_anew) << "it moves";
  EXPECT_TRUE(after(supervisor, wrong, time, Supervisor::kStanding + 0.2, 0.0).may_begin_anew);
  EXPECT_FALSE(after(supervisor, wrong, time, 20.0, 0.0).may_begin_anew) << "not twice within a minute";
  supervisor.rearm();
  EXPECT_TRUE(after(supervisor, wrong, time, Supervisor::kStanding + 0.2, 0.0).may_begin_anew) << "a person";
}

/// Believed after three seconds, a place that had jumped by 5 m led a car off the road that it stood on.
TEST(Supervisor, BelievesAPlaceThatJumpedOnlyWhenAPersonHasTakenOver) {
  for (const Findings& jump : {Findings{.heading_jump = true}, Findings{.position_jump = true}}) {
    Supervisor supervisor;
    double time = 0.0;
    EXPECT_FALSE(after(supervisor, jump, time, 200.0, 0.0).may_begin_anew);
    supervisor.rearm();
    EXPECT_FALSE(after(supervisor, jump, time, 5.0, 5.0).may_begin_anew) << "it moves";
    EXPECT_TRUE(after(supervisor, jump, time, Supervisor::kStanding + 0.2, 0.0).may_begin_anew);
    EXPECT_FALSE(after(supervisor, jump, time, 200.0, 0.0).may_begin_anew);
  }
}

}  // namespace
}  // namespace chicane::safety
