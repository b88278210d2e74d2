// SPDX-License-Identifier: MIT
#include "chicane/sweep/tune.hpp"

#include "chicane/protocol/library.hpp"
#include "support/chicane_test.hpp"
#include "support/folder.hpp"

namespace chicane::sweep {
namespace {

TuneTask task() {
  return {.settings = {{"preset", "pure-pursuit"}, {"track", "oval"}},
          .over = {"pure_pursuit.lookahead_time_s"},
          .evaluations = 4};
}

class Tune : public testing::Test, protected test::Folder {
 protected:
  void SetUp() override {
    const std::string refusal = test::refusal_of(tune(task(), std::atomic<bool>{true}));
    if (refusal.find("without NLopt") != std::string::npos) GTEST_SKIP() << refusal;
  }
  const std::atomic<bool> stop_{false};
};

TEST(TuneTask, ChangesWeightsHorizonAndSpeedOfTheControllerThatDrives) {
  const auto keys = default_keys(protocol::compose({"", {{"preset", "weighted"}}}).value());
  EXPECT_THAT(keys, Contains("cubic_mpc.weight_lateral"));
  EXPECT_THAT(keys, Contains("cubic_mpc.horizon_steps"));
  EXPECT_THAT(keys, Contains("cubic_mpc.speed_reference_mps"));
  EXPECT_THAT(keys, Not(Contains("cubic_mpc.weight_speed_steer"))) << "is zero in this preset";
  EXPECT_THAT(keys, Not(Contains("cubic_mpc.latency_ms")));
}

TEST_F(Tune, FindsTheSameForTheSameSeedOnAnyNumberOfThreads) {
  TuneTask one = task();
  const auto first = test::good(tune(one, stop_));
  EXPECT_EQ(first->evaluations, 4);
  one.jobs = 3;
  const auto again = test::good(tune(one, stop_));
  EXPECT_EQ(again->values, first->values);
  EXPECT_EQ(again->found.margin, first->found.margin);
  EXPECT_TRUE(first->by_hand.lap_time > 0.0);
}

TEST_F(Tune, ASearchThatWasEndedGoesOnWithItsLogAndFindsTheSame) {
  TuneTask whole = task();
  whole.evaluations = 6;
  whole.log = path("whole.jsonl");
  const auto expected = test::good(tune(whole, stop_));

  TuneTask parts = whole;
  parts.log = path("parts.jsonl");
  parts.evaluations = 3;
  ASSERT_TRUE(tune(parts, stop_));
  std::ofstream(parts.log, std::ios::app) << R"({"values":{"pure_purs)";  // a process was killed there
  parts.evaluations = 6;
  const auto found = test::good(tune(parts, stop_));
  EXPECT_EQ(found->values, expected->values);
  EXPECT_EQ(found->found.margin, expected->found.margin);
  EXPECT_EQ(found->runs, expected->runs);
  EXPECT_EQ(test::content_of(parts.log), test::content_of(whole.log));

  const auto again = tune(whole, stop_);  // all is known
  ASSERT_TRUE(again);
  EXPECT_EQ(test::content_of(parts.log), test::content_of(whole.log)) << "nothing was driven twice";

  TuneTask other = whole;
  other.settings.emplace_back("plant_options.friction_scale", "0.8");
  EXPECT_THAT(tune(other, stop_).error().message, HasSubstr("log of another search"));
}

TEST_F(Tune, ALogIsNotGoneOnWithWhenThePresetHasChanged) {
  TuneTask theirs = task();
  theirs.evaluations = 1;
  theirs.log = path("theirs.jsonl");
  const std::string preset = path("theirs.yaml");
  theirs.settings[0].second = preset;
  std::ofstream(preset) << "controller: pure-pursuit\npure_pursuit: {lookahead_min_m: 5}\n";
  const auto first = test::good(tune(theirs, stop_));
  std::ofstream(preset) << "controller: pure-pursuit\npure_pursuit: {lookahead_min_m: 6}\n";
  EXPECT_THAT(tune(theirs, stop_).error().message, HasSubstr("log of another search"));
}

TEST_F(Tune, WhatCannotWinIsTriedNoFurther) {
  TuneTask hasty = task();
  hasty.evaluations = 20;
  hasty.log = path("hasty.jsonl");
  const auto tuning = test::good(tune(hasty, stop_));
  const auto trials = static_cast<int>(tune_trials(0.1).size());
  EXPECT_EQ(tuning->by_hand.driven, trials);
  EXPECT_EQ(tuning->found.passed, trials);
  EXPECT_LT(tuning->runs, trials * tuning->evaluations) << "some look ahead too short or too far";
  const std::string log = test::content_of(hasty.log);
  EXPECT_THAT(log, HasSubstr(R"("driven":1,"passed":0)"));
  EXPECT_THAT(log, Not(HasSubstr(R"("driven":6,"passed":4)"))) << "ends with the first trial that is failed";
}

#ifdef CHICANE_SLOW_TESTS
TEST_F(Tune, ASearchThatHasConvergedGoesOnUntilItHasTriedWhatWasAsked) {
  TuneTask local = task();
  local.optimizer = Optimizer::kSbplx;
  local.evaluations = 80;  // of one number: converges after 65
  const auto tuning = test::good(tune(local, stop_));
  EXPECT_EQ(tuning->evaluations, 80);
}
#endif

TEST(TuneTask, HasEachTrialOfItsOwn) {
  const auto trials = tune_trials(0.02);
  for (std::size_t i = 0; i < trials.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(trials[i].settings, trials[j].settings) << i << ' ' << j;
  for (const TuneTrial& trial : trials)
    EXPECT_TRUE(protocol::compose({"", trial.settings})) << trial.name << " is what every run takes";
}

TEST_F(Tune, AWorseTuningIsNeverCalledBetter) {
  for (const Objective objective : {Objective::kLap, Objective::kRobust}) {
    TuneTask each = task();
    each.objective = objective;
    each.optimizer = Optimizer::kSbplx;
    const auto tuning = test::good(tune(each, stop_));
    if (!tuning->is_better) continue;
    EXPECT_TRUE(tuning->found.is_clean());
    EXPECT_GE(tuning->found.margin, tuning->by_hand.margin);
  }
}

TEST(TuneTask, RefusesWhatIsNoNumberAboveZero) {
  const std::atomic<bool> stop{false};
  for (const char* key : {"pure_pursuit.nothing", "track", "sensor.position_noise_m"}) {
    TuneTask wrong = task();
    wrong.over = {key};
    EXPECT_THAT(tune(wrong, stop).error().message, HasSubstr("expected a number above zero")) << key;
  }
}

}  // namespace
}  // namespace chicane::sweep
