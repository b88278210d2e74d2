// SPDX-License-Identifier: MIT
#include "chicane/sweep/tune.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "chicane/protocol/library.hpp"

namespace chicane::sweep {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

TuneTask task() {
  return {.settings = {{"preset", "pure-pursuit"}, {"track", "oval"}},
          .over = {"pure_pursuit.lookahead_time_s"},
          .evaluations = 4};
}

bool is_without_nlopt(const Result<Tuning>& tuning) {
  return !tuning && tuning.error().message.find("without NLopt") != std::string::npos;
}

TEST(Tune, ChangesWeightsHorizonAndSpeedOfTheControllerThatDrives) {
  const auto keys = default_keys(protocol::compose({"", {{"preset", "weighted"}}}).value());
  EXPECT_THAT(keys, Contains("cubic_mpc.weight_lateral"));
  EXPECT_THAT(keys, Contains("cubic_mpc.horizon_steps"));
  EXPECT_THAT(keys, Contains("cubic_mpc.speed_reference_mps"));
  EXPECT_THAT(keys, Not(Contains("cubic_mpc.weight_speed_steer"))) << "is zero in this preset";
  EXPECT_THAT(keys, Not(Contains("cubic_mpc.latency_ms")));
}

TEST(Tune, FindsTheSameForTheSameSeedOnAnyNumberOfThreads) {
  std::atomic<bool> stop{false};
  TuneTask one = task();
  const auto first = tune(one, stop);
  if (is_without_nlopt(first)) GTEST_SKIP() << first.error().message;
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_EQ(first->evaluations, 4);
  one.jobs = 3;
  const auto again = tune(one, stop);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->values, first->values);
  EXPECT_EQ(again->found.margin, first->found.margin);
  EXPECT_TRUE(first->by_hand.lap_time > 0.0);
}

TEST(Tune, AWorseTuningIsNeverCalledBetter) {
  std::atomic<bool> stop{false};
  for (const Objective objective : {Objective::kLap, Objective::kRobust}) {
    TuneTask each = task();
    each.objective = objective;
    each.optimizer = Optimizer::kSbplx;
    const auto tuning = tune(each, stop);
    if (is_without_nlopt(tuning)) GTEST_SKIP() << tuning.error().message;
    ASSERT_TRUE(tuning);
    if (!tuning->is_better) continue;
    EXPECT_TRUE(tuning->found.is_clean());
    EXPECT_GE(tuning->found.margin, tuning->by_hand.margin);
  }
}

TEST(Tune, RefusesWhatIsNoNumberAboveZero) {
  std::atomic<bool> stop{false};
  for (const char* key : {"pure_pursuit.nothing", "track", "sensor.position_noise_m"}) {
    TuneTask wrong = task();
    wrong.over = {key};
    EXPECT_THAT(tune(wrong, stop).error().message, HasSubstr("expected a number above zero")) << key;
  }
}

}  // namespace
}  // namespace chicane::sweep
