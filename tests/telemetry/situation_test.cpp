// SPDX-License-Identifier: MIT
#include "chicane/telemetry/frame.hpp"
#include "support/chicane_test.hpp"

namespace chicane::telemetry {
namespace {

using controller::GuardReason;
using controller::Rung;

constexpr std::array kCorners{road::Corner{.begin = 100.0, .apex = 120.0, .end = 150.0, .turn = 1.0},
                              road::Corner{.begin = 900.0, .apex = 980.0, .end = 20.0, .turn = -1.0}};

/// Of a car on the straight before T1, at 20 m/s.
Frame driven(double time, double pedal, double grip = 0.3) {
  Frame frame;
  frame.time = time;
  frame.cycle = 1;
  frame.has_truth = frame.is_judged = true;
  frame.truth.vx = 20.0;
  frame.s = 60.0;
  frame.edge_distance = 1.0;
  frame.applied.throttle = pedal;
  frame.tire_use = {grip, 0.5 * grip};
  return frame;
}

Situation next(const Frame& frame, const Situation& before = {}) {
  return situation_of(frame, before, {.full_brake = 0.5, .corners = kCorners});
}

TEST(Situation, SaysWhatTheAppliedCommandDoes) {
  EXPECT_EQ(sentence_of(next(driven(9.0, -0.2))), "Brakes for T1");
  EXPECT_EQ(sentence_of(next(driven(9.0, 1.0))), "Full throttle");
  EXPECT_EQ(sentence_of(next(driven(9.0, 0.02))), "Rolls towards T1");
  EXPECT_EQ(sentence_of(next(driven(9.0, 0.4))), "Part throttle before T1");
  EXPECT_EQ(sentence_of(next(driven(9.0, -0.2, 0.97))), "Grip: 97 % before T1");
  Frame in_bend = driven(9.0, 0.4, 0.97);
  in_bend.s = 5.0;
  EXPECT_EQ(sentence_of(next(in_bend)), "Grip: 97 % in T2") << "across the start line";
  in_bend.s = 300.0;
  EXPECT_EQ(sentence_of(next(in_bend)), "Grip: 97 %") << "far from any corner";
  in_bend.is_judged = false;
  EXPECT_EQ(sentence_of(next(in_bend)), "Grip: 97 %");
}

TEST(Situation, KeepsASentenceThatIsStillTrueForSevenTenths) {
  const Situation brakes = next(driven(9.0, -0.2, 0.6));
  EXPECT_EQ(next(driven(9.5, -0.2, 0.8), brakes).kind, SituationKind::kBrakes);
  EXPECT_EQ(next(driven(9.8, -0.2, 0.8), brakes).kind, SituationKind::kGrip);
  EXPECT_EQ(next(driven(9.1, 0.4, 0.6), brakes).kind, SituationKind::kPartThrottle) << "it is not true";
}

TEST(Situation, NamesReasonAndKeyOfAStopAndCountsItOnce) {
  Frame frame = driven(9.0, 0.4);
  frame.guard = {.rung = Rung::kGuardStop, .reason = GuardReason::kPositionJump};
  const Situation stop = next(frame);
  EXPECT_EQ(sentence_of(stop), "The guard stops the car");
  EXPECT_EQ(reason_of(stop), controller::word_of(GuardReason::kPositionJump).sentence);
  EXPECT_EQ(what_ends(stop),
            "It ends when the measurements agree, or answer a trial of half a metre. "
            "On the dashboard, M takes the wheel and R starts again.");
  EXPECT_EQ(stop.driver, Situation::Driver::kGuard);
  frame.time = 9.2;
  frame.guard = {};
  const Situation pause = next(frame, stop);
  EXPECT_EQ(severity_of(pause), Severity::kOk);
  frame.time = 9.4;
  frame.guard = {.rung = Rung::kGuardStop, .reason = GuardReason::kNoAnswer};
  frame.truth.vx = 0.0;
  const Situation held = next(frame, pause);
  EXPECT_EQ(sentence_of(held), "The guard holds the car");
  EXPECT_EQ(held.alarms, 1U) << "one event";
  frame.time = 12.0;
  EXPECT_EQ(next(frame, held).alarms, 2U) << "another one after a pause";
}

TEST(Situation, KnowsEverySourceAndEveryReason) {
  Frame frame = driven(9.0, 0.4);
  for (const Word<Rung>& rung : controller::kRungWords) {
    for (const Word<GuardReason>& reason : controller::kGuardReasonWords) {
      frame.guard = {.rung = rung.value, .reason = reason.value};
      const Situation now = next(frame);
      if (rung.value == Rung::kController) continue;
      EXPECT_EQ(severity_of(now), rung.severity) << rung.name;
      EXPECT_EQ(reason_of(now), reason.value != GuardReason::kNone  ? reason.sentence
                                : rung.severity == Severity::kError ? rung.sentence
                                                                    : std::string_view{})
          << rung.name << " " << reason.name;
    }
  }
}

TEST(Situation, CallsACarStuckByItsMotion) {
  Frame frame = driven(0.0, -0.5);
  frame.truth.vx = 0.05;
  Situation now = next(frame);
  EXPECT_EQ(sentence_of(now), "The car stands");
  EXPECT_EQ(what_ends(now), "");
  frame.time = 3.0;
  now = next(frame, now);
  EXPECT_EQ(sentence_of(now), "The car stands and should drive");
  EXPECT_EQ(reason_of(now), "the controller brakes");
  EXPECT_EQ(what_ends(now),
            "It ends when the car moves. On the dashboard, M takes the wheel and R starts again.");
  frame.is_manual = true;
  EXPECT_EQ(sentence_of(next(frame, now)), "A person drives");
  frame.is_manual = false;
  frame.truth.vx = 1.0;
  EXPECT_EQ(sentence_of(next(frame, now)), "Brakes for T1");
}

TEST(Situation, TakesWhatTheGuardFoundForANotice) {
  Frame frame = driven(9.0, 0.4);
  frame.guard.reason = GuardReason::kTooFastForSilence;
  EXPECT_EQ(sentence_of(next(frame)), "The guard limits the throttle");
  EXPECT_EQ(severity_of(next(frame)), Severity::kWarning);
  frame.guard.reason = GuardReason::kFrozen;
  EXPECT_EQ(sentence_of(next(frame)), "The guard would stop the car");
  frame.is_off_track = true;
  frame.edge_distance = -1.23;
  EXPECT_EQ(sentence_of(next(frame)), "Off the road by 1.2 m");
  frame.is_manual = true;
  EXPECT_EQ(sentence_of(next(frame)), "Off the road by 1.2 m");
  EXPECT_EQ(next(frame).driver, Situation::Driver::kPerson);
}

}  // namespace
}  // namespace chicane::telemetry
