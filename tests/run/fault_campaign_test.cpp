// SPDX-License-Identifier: MIT
#include "chicane/run/fault_campaign.hpp"

#include "support/chicane_test.hpp"
#include "support/own_controller.hpp"
#include "support/runs.hpp"

namespace chicane::run {
namespace {

scenario::Scenario on_oval(const char* mode = "on") {
  return test::scenario_of({{"track", "oval"}, {"guard.mode", mode}});
}

/// Trials of one fault at each `step` [s] of the flying lap.
std::vector<FaultTrial> trials_over_lap(const FlyingLap& lap, const char* fault, double duration,
                                        double step) {
  std::vector<FaultTrial> trials;
  for (int i = 0; i * step < lap.time; ++i)
    trials.push_back({.fault = *sim::fault_named(fault),
                      .onset = i * step,
                      .duration = duration,
                      .strength = sim::kind_of(*sim::fault_named(fault)).strength});
  return trials;
}

TEST(FaultCampaign, FindsTheFlyingLapOrTakesAnOpenRoadFromItsStartToItsEnd) {
  const auto lap = test::good(drive_undisturbed(on_oval(), 0.0));
  EXPECT_GT(lap->begins, 10.0);
  EXPECT_GT(lap->time, 10.0);
  EXPECT_LT(lap->time, lap->begins) << "the first lap is from standstill";
  const auto stage = test::good(drive_undisturbed(test::scenario_of({{"track", "stage"}}), 0.0));
  EXPECT_EQ(stage->begins, 0.0);
  EXPECT_GT(stage->time, 30.0);
}

/// What goes before the fault is driven once for all trials; nobody can tell.
TEST(FaultCampaign, EachTrialIsAsIfDrivenAlone) {
  const scenario::Scenario scenario = on_oval();
  const auto lap = test::good(drive_undisturbed(scenario, 0.0));
  auto trials = trials_over_lap(*lap, "gps_noise", 1.0, 7.3);
  const auto more = trials_over_lap(*lap, "link_lost", kLasting, 5.1);
  trials.insert(trials.end(), more.begin(), more.end());
  const auto together = test::good(drive_trials(scenario, *lap, trials, 2));
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const auto alone = test::good(drive_trials(scenario, *lap, {trials[i]}, 1));
    EXPECT_EQ((*together)[i].least_edge, (*alone)[0].least_edge) << i;
    EXPECT_NEAR((*together)[i].at, lap->begins + trials[i].onset, 1e-3);
    EXPECT_EQ((*together)[i].end_speed, (*alone)[0].end_speed) << i;
    EXPECT_EQ((*together)[i].not_controller, (*alone)[0].not_controller) << i;
  }
}

TEST(FaultCampaign, EndsEarlyWithWhatItHas) {
  const scenario::Scenario scenario = on_oval();
  const auto lap = drive_undisturbed(scenario, 0.0);
  const auto trials = trials_over_lap(*lap, "gps_noise", 0.5, 4.0);
  const auto outcomes = drive_trials(scenario, *lap, trials, 1, [](std::size_t done) { return done < 2; });
  ASSERT_TRUE(outcomes);
  EXPECT_TRUE(std::isfinite((*outcomes)[1].least_edge));
  EXPECT_FALSE(std::isfinite((*outcomes)[2].least_edge));
}

TEST(FaultCampaign, NeedsAControllerThatCanBeCopied) {
  EXPECT_EQ(test::refusal_of(
                drive_trials(on_oval(), {.begins = 1.0}, {FaultTrial{}}, 1, {}, test::make_own_controller)),
            "trials need a controller and a plant with copy()");
}

/// Where the stop is driven by wheel speed and steering alone, the car comes as far as the guard was told
/// that it must (docs/safety.md).
TEST(FaultCampaign, ASilenceMayLastAsLongAsTheGuardIsTold) {
  const auto least_edges = [](const char* track, double silence, const char* blind_time,
                              const std::vector<double>& onsets, const char* fault = "link_lost") {
    const auto scenario =
        test::scenario_of({{"track", track}, {"car", "road-car"}, {"guard.blind_time_s", blind_time}});
    const auto lap = drive_undisturbed(scenario, 0.0);
    EXPECT_TRUE(lap);
    std::vector<FaultTrial> trials;
    for (const double onset : onsets)
      trials.push_back({.fault = *sim::fault_named(fault), .onset = onset, .duration = silence});
    const auto outcomes = drive_trials(scenario, *lap, trials, 2);
    EXPECT_TRUE(outcomes);
    std::vector<double> edges;
    for (const FaultOutcome& outcome : outcomes.value_or(std::vector<FaultOutcome>{}))
      edges.push_back(outcome.least_edge);
    return edges;
  };
  EXPECT_THAT(least_edges("oval", 2.0, "2", {16.0}), testing::Each(testing::Gt(0.5)));
#ifdef CHICANE_SLOW_TESTS
  EXPECT_THAT(least_edges("lakeside", kLasting, "30", {12.0}), testing::Each(testing::Gt(0.0)));
  // Where a car that brakes into a bend was lost by up to 60 m.
  EXPECT_THAT(least_edges("speedway", kLasting, "30", {27.0, 69.0}, "dead_controller"),
              testing::Each(testing::Gt(0.0)));
#endif
}

/// What the guard is for: without it the same trials leave the road.
TEST(FaultCampaign, TellsGuardedFromUnguarded) {
  const auto off = [](const char* mode) {
    const scenario::Scenario scenario = on_oval(mode);
    const auto lap = drive_undisturbed(scenario, 0.0);
    const auto trials = trials_over_lap(*lap, "frozen_sensor", kLasting, 2.5);
    int count = 0;
    const auto outcomes = drive_trials(scenario, *lap, trials, 2);
    EXPECT_TRUE(outcomes);
    for (const FaultOutcome& outcome : outcomes.value_or(std::vector<FaultOutcome>{})) {
      count += outcome.has_left_road() ? 1 : 0;
      if (std::string_view(mode) == "on") {
        EXPECT_TRUE(outcome.stands()) << outcome.at;
      }
    }
    return count;
  };
  EXPECT_EQ(off("on"), 0);
  EXPECT_GT(off("off"), 0);
}

}  // namespace
}  // namespace chicane::run
