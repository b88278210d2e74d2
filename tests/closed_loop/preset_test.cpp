// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "chicane/base/random.hpp"
#include "closed_loop/drive.hpp"

namespace chicane::run {
namespace {

/// What a write-up claims for its preset.
struct Claim {
  const char* preset;
  double low_mph;  ///< the top speed lies between these two
  double high_mph;
};

/// docs/problem.md, table 2: 30 to 40; about 50; 50 to 60; none given; as fast as stays stable.
constexpr Claim kClaims[] = {{"measured-latency", 38.0, 42.0}, {"fast-short-step", 48.0, 53.0},
                             {"sixty-mph", 57.0, 62.0},        {"weighted", 45.0, 53.0},
                             {"delay-in-model", 80.0, 92.0},   {"pid", 28.0, 31.0},
                             {"pure-pursuit", 28.0, 31.0},     {"stanley", 28.0, 31.0}};

void expect_clean_laps(const telemetry::RunSummary& run) {
  EXPECT_TRUE(run.completed) << run.preset << " on " << run.track << ": " << run.end_reason;
  EXPECT_EQ(run.off_track_events, 0) << run.preset << " on " << run.track;
  EXPECT_EQ(run.fallbacks, 0U) << run.preset << " on " << run.track;
}

TEST(Presets, LapTheLakesideCleanlyAtTheSpeedTheyClaim) {
  for (const Claim& claim : kClaims) {
    const auto run = drive({{"guard.mode", "off"},
                            {"preset", claim.preset},
                            {"track", "lakeside"},
                            {"laps", "3"},
                            {"latency_ms", "100"}});
    expect_clean_laps(run);
    EXPECT_GE(top_mph(run), claim.low_mph) << claim.preset;
    EXPECT_LE(top_mph(run), claim.high_mph) << claim.preset;
  }
}

TEST(Presets, LapTheOriginalLakeCleanlyAtTheSpeedTheyClaim) {
  for (const Claim& claim : kClaims) {
    const auto run = drive({{"guard.mode", "off"},
                            {"preset", claim.preset},
                            {"track", "original-lake"},
                            {"laps", "3"},
                            {"latency_ms", "100"}});
    expect_clean_laps(run);
    EXPECT_GE(top_mph(run), claim.low_mph) << claim.preset;
    EXPECT_LE(top_mph(run), claim.high_mph) << claim.preset;
  }
}

/// As they are driven unless said otherwise: the guard may hold them back, and does them no harm.
TEST(Presets, LapTheLakesideWithTheGuardOn) {
  for (const Claim& claim : kClaims) {
    const auto run =
        drive({{"preset", claim.preset}, {"track", "lakeside"}, {"laps", "3"}, {"latency_ms", "100"}});
    EXPECT_TRUE(run.completed) << claim.preset << ": " << run.end_reason;
    EXPECT_EQ(run.off_track_events, 0) << claim.preset;
    EXPECT_GE(top_mph(run), claim.low_mph) << claim.preset;
    EXPECT_LT(run.fallbacks, 20U) << claim.preset;
  }
}

/// Latencies of 80 to 180 ms and up to 60 ms of jitter: sensors and actuators are in order, and the guard
/// that watches them finds nothing, wherever the preset stays on the road.
TEST(Presets, AreNeverTakenForCarsWithFaults) {
  using enum controller::GuardReason;
  constexpr int kDraws = kDrivesAll ? 100 : 4;
  constexpr const char* kTracks[] = {"lakeside", "original-lake", "oval", "hairpins"};
  const std::uint64_t seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  std::vector<const char*> presets{"default"};
  for (const Claim& claim : kClaims) presets.push_back(claim.preset);
  for (const char* preset : presets)
    for (int i = 0; i < kDraws; ++i) {
      const Settings settings{{"guard.mode", "observe"},
                              {"preset", preset},
                              {"track", kTracks[i % 4]},
                              {"laps", "2"},
                              {"latency_ms", std::to_string(random.uniform(80.0, 180.0))},
                              {"latency_jitter_ms", std::to_string(random.uniform(0.0, 60.0))},
                              {"seed", std::to_string(1 + random.bits() % 1000)}};
      const auto run = drive(settings);
      if (!run.completed || run.off_track_events > 0) continue;
      for (const controller::GuardReason reason : {kNotMeasured, kFrozen, kSpeedMismatch, kHeadingJump,
                                                   kPositionJump, kLate, kOtherSteering, kWeakBrakes})
        EXPECT_EQ(run.guard_reasons[static_cast<std::size_t>(reason)], 0U)
            << controller::word_of(reason).sentence << ": " << preset << ' ' << settings[2].second << ' '
            << settings[4].second << ' ' << settings[5].second << ' ' << settings[6].second;
    }
}

TEST(Presets, StayOnTheRoadWhenTheAnswerIsLateOrSlow) {
  // Answers of the original take 110 to 160 ms, by machine (docs/protocol.md): the presets are not tuned to
  // one of them.
  for (const char* preset :
       {"measured-latency", "fast-short-step", "sixty-mph", "weighted", "delay-in-model"}) {
    for (const auto& [latency, period] :
         {std::pair{"100", "100"}, {"110", "130"}, {"120", "140"}, {"100", "150"}}) {
      const auto run = drive({{"guard.mode", "off"},
                              {"preset", preset},
                              {"track", "lakeside"},
                              {"laps", "2"},
                              {"latency_ms", latency},
                              {"control_period_ms", period}});
      EXPECT_TRUE(run.completed) << preset << ' ' << latency << ' ' << period;
      EXPECT_EQ(run.off_track_events, 0) << preset << ' ' << latency << ' ' << period;
    }
  }
}

TEST(Presets, MeasuredLatencyWorksToFifty) {
  const auto run = drive({{"guard.mode", "off"},
                          {"preset", "measured-latency"},
                          {"track", "lakeside"},
                          {"laps", "2"},
                          {"cubic_mpc.speed_reference_mps", "22.352"}});
  expect_clean_laps(run);
  EXPECT_GE(top_mph(run), 49.0);
}

/// On the lake that it was written for; on lakeside it leaves the road (docs/claims.md, A6).
TEST(Presets, MeasuredLatencyLapsTheOriginalLakeWithBothErrorsAsWritten) {
  for (const char* speed_mps : {"13.4112", "17.8816", "22.352"}) {  // 30, 40, 50 mph
    SCOPED_TRACE(speed_mps);
    expect_clean_laps(drive({{"guard.mode", "off"},
                             {"preset", "measured-latency"},
                             {"track", "original-lake"},
                             {"laps", "3"},
                             {"cubic_mpc.speed_reference_mps", speed_mps},
                             {"cubic_mpc.lateral_error_integrated", "true"}}));
  }
}

TEST(Presets, FastShortStepTakesItsSpeedFromTheWeightOnAcceleration) {
  const auto slow =
      drive({{"guard.mode", "off"}, {"preset", "fast-short-step"}, {"track", "lakeside"}, {"laps", "2"}});
  const auto fast = drive({{"guard.mode", "off"},
                           {"preset", "fast-short-step"},
                           {"track", "lakeside"},
                           {"laps", "2"},
                           {"cubic_mpc.weight_throttle", "48"}});
  expect_clean_laps(fast);
  EXPECT_LT(slow.total.rms_lateral_error, 0.5);  // "in the centre of the lane"
  EXPECT_GT(top_mph(fast), top_mph(slow) + 15.0);
}

TEST(Presets, WeightedSlowsInCurvesAndDelayInModelForThem) {
  const auto weighted =
      drive({{"guard.mode", "off"}, {"preset", "weighted"}, {"track", "lakeside"}, {"laps", "2"}});
  ASSERT_EQ(weighted.laps.size(), 2U);
  EXPECT_LT(weighted.laps[1].mean_speed, 0.95 * weighted.laps[1].top_speed);
  const auto delayed =
      drive({{"guard.mode", "off"}, {"preset", "delay-in-model"}, {"track", "lakeside"}, {"laps", "2"}});
  ASSERT_EQ(delayed.laps.size(), 2U);
  EXPECT_LT(delayed.laps[1].mean_speed, 0.9 * delayed.laps[1].top_speed);
}

}  // namespace
}  // namespace chicane::run
