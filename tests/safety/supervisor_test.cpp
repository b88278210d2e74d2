// SPDX-License-Identifier: MIT
#include "chicane/safety/supervisor.hpp"

#include <gtest/gtest.h>

#include <iterator>

namespace chicane::safety {
namespace {

using enum controller::GuardReason;

/// Judges `findings` each 40 ms for `seconds`; the last verdict.
Supervisor::Verdict after(Supervisor& supervisor, const Findings& findings, double& time, double seconds) {
  Supervisor::Verdict verdict;
  for (const double end = time + seconds; time < end; time += 0.04)
    verdict = supervisor.judge(findings, time);
  return verdict;
}

TEST(Supervisor, ToleratesWhatIsShortAndStopsForWhatLasts) {
  for (const Condition& each : kConditions) {
    if (each.finding == nullptr) continue;
    Findings findings;
    findings.*each.finding = true;
    Supervisor supervisor;
    EXPECT_FALSE(supervisor.judge({}, 10.0).must_stop);
    if (each.tolerated > 0.0) {
      EXPECT_FALSE(supervisor.judge(findings, 10.0 + 0.999 * each.tolerated).must_stop);
    }
    const Supervisor::Verdict verdict = supervisor.judge(findings, 10.001 + each.tolerated);
    EXPECT_TRUE(verdict.must_stop);
    EXPECT_EQ(verdict.reason, each.reason);
    EXPECT_FALSE(supervisor.judge({}, 10.01 + each.tolerated).must_stop) << "it ends by itself";
    EXPECT_EQ(supervisor.judge({}, 10.02 + each.tolerated).reason, kNone);
  }
}

/// What a condition costs a car and a driver: a change of this table is a decision.
TEST(Supervisor, HasEachConditionWithItsTimeInTheOrderOfSeverity) {
  const struct {
    bool Findings::*finding;
    controller::GuardReason reason;
    double tolerated;
    ConditionEnd ends;
  } expected[] = {{&Findings::late, kLate, 0.12, ConditionEnd::kByItself},
                  {&Findings::unmeasured, kNotMeasured, 0.12, ConditionEnd::kByItself},
                  {&Findings::frozen, kFrozen, 0.0, ConditionEnd::kByItself},
                  {&Findings::speed_mismatch, kSpeedMismatch, 0.1, ConditionEnd::kByTrial},
                  {&Findings::heading_jump, kHeadingJump, 0.1, ConditionEnd::kByTrial},
                  {&Findings::position_jump, kPositionJump, 0.1, ConditionEnd::kByTrial},
                  {nullptr, kNoAnswer, 0.0, ConditionEnd::kByAnswer},
                  {nullptr, kNoWayToStop, 0.0, ConditionEnd::kByAnswer},
                  {nullptr, kFarFromRoad, 0.0, ConditionEnd::kByAnswer},
                  {nullptr, kTooFastForSilence, 0.0, ConditionEnd::kByAnswer},
                  {nullptr, kOtherSteering, 0.0, ConditionEnd::kByMotion},
                  {nullptr, kWeakBrakes, 0.0, ConditionEnd::kByMotion},
                  {nullptr, kStuck, 0.0, ConditionEnd::kByMotion},
                  {nullptr, kFacesEdge, 0.0, ConditionEnd::kByPerson}};
  ASSERT_EQ(kConditions.size(), std::size(expected));
  for (std::size_t i = 0; i < kConditions.size(); ++i) {
    EXPECT_EQ(kConditions[i].finding, expected[i].finding) << i;
    EXPECT_EQ(kConditions[i].reason, expected[i].reason) << i;
    EXPECT_EQ(kConditions[i].tolerated, expected[i].tolerated) << i;
    EXPECT_EQ(kConditions[i].ends, expected[i].ends) << i;
  }
}

TEST(Supervisor, StopsAtOnceForAFrozenSensor) {
  Supervisor supervisor;
  EXPECT_TRUE(supervisor.judge({.frozen = true}, 5.0).must_stop);
}

/// At 300 ms between measurements the first one in doubt comes 300 ms after the last good one.
TEST(Supervisor, StopsForASpeedThatTwoMeasurementsShow) {
  for (const Condition& each : kConditions) {
    if (each.finding == nullptr) continue;
    Findings findings;
    findings.*each.finding = true;
    Supervisor supervisor;
    EXPECT_FALSE(supervisor.judge({}, 5.0).must_stop);
    EXPECT_EQ(supervisor.judge(findings, 5.3).must_stop, each.reason != kSpeedMismatch);
    EXPECT_TRUE(supervisor.judge(findings, 5.6).must_stop);
  }
}

TEST(Supervisor, NamesTheWorstCondition) {
  Supervisor supervisor;
  double time = 0.0;
  EXPECT_EQ(after(supervisor, {.unmeasured = true, .position_jump = true}, time, 1.0).reason, kPositionJump);
  // The worst that has lasted: a jump of this moment is tolerated.
  EXPECT_EQ(supervisor.judge({.unmeasured = true}, time).reason, kNotMeasured);
  EXPECT_EQ(supervisor.judge({.unmeasured = true, .position_jump = true}, time + 0.04).reason, kNotMeasured);
}

TEST(Supervisor, ForgetsAllOnReset) {
  Supervisor supervisor;
  double time = 0.0;
  EXPECT_TRUE(after(supervisor, {.heading_jump = true}, time, 5.0).must_stop);
  supervisor.reset();
  EXPECT_FALSE(supervisor.judge({.heading_jump = true}, 0.05).must_stop);
}

TEST(Supervisor, WantsATrialWhereSpeedHeadingOrPlaceIsInDoubt) {
  EXPECT_FALSE(Supervisor::wants_trial({.late = true, .unmeasured = true, .frozen = true}));
  EXPECT_TRUE(Supervisor::wants_trial({.speed_mismatch = true}));
  EXPECT_TRUE(Supervisor::wants_trial({.heading_jump = true}));
  EXPECT_TRUE(Supervisor::wants_trial({.position_jump = true}));
}

}  // namespace
}  // namespace chicane::safety
