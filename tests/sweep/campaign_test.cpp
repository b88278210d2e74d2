// SPDX-License-Identifier: MIT
#include "chicane/sweep/campaign.hpp"

#include <unistd.h>

#include "chicane/protocol/json.hpp"
#include "chicane/run/fault_campaign.hpp"
#include "chicane/sweep/result_file.hpp"
#include "chicane/sweep/trial.hpp"
#include "support/chicane_test.hpp"
#include "support/folder.hpp"

namespace chicane::sweep {
namespace {

class CampaignTest : public testing::Test, protected test::Folder {
 protected:
  Result<Progress> drive(const char* file, std::uint64_t stop_after = 1000, int jobs = 2) {
    std::atomic<bool> stop{false};
    return drive_plan(
        plan_of(campaign_), {},
        {.file = path(file), .on_progress = [&](const Progress& now) { stop = now.driven >= stop_after; }},
        rule_of(campaign_, jobs, stop), stop);
  }
  [[nodiscard]] Result<std::vector<CampaignGroup>> groups_of(const char* file) const {
    std::vector<CampaignGroup> groups;
    const auto add = [&](std::uint64_t, const protocol::Json& line) -> Result<void> {
      Result<CampaignGroup> group = group_of(line);
      if (!group) return fail(group.error());
      groups.push_back(std::move(*group));
      return {};
    };
    const auto accept = [](const Header&) { return Result<void>{}; };
    if (const auto read = read_runs(path(file), accept, add); !read) return fail(read.error());
    return groups;
  }

  Campaign campaign_{.tracks = {"oval"},
                     .cars = {"udacity"},
                     .presets = {"default", "pid"},
                     .faults = {"frozen_sensor", "gps_noise"},
                     .has_pairs = true,
                     .durations = {1.0, run::kLasting},
                     .onsets = 2,
                     .settings = {{"guard.mode", "off"}}};
};

TEST(SignalFaults, AreThoseThatLeaveCarAndRoadAsTheyAre) {
  EXPECT_THAT(signal_faults(),
              ElementsAre("link_lost", "frozen_sensor", "nan_measurement", "position_jump", "gps_noise",
                          "speed_sensor_zero", "waypoints_missing", "slow_solver", "dead_controller",
                          "delay_doubled", "command_dropped"));
}

TEST_F(CampaignTest, TriesFaultsAndPairsForEachDuration) {
  const Plan plan = plan_of(campaign_);
  EXPECT_EQ(plan.size(), 2U * 3U * 2U);
  EXPECT_EQ(plan.at(4)[3].second, "frozen_sensor+gps_noise");
  EXPECT_EQ(plan.at(5)[4].second, "inf");
  Campaign other = campaign_;
  other.seed = 2;
  EXPECT_NE(plan.hash(), plan_of(other).hash()) << "other moments";
  const auto done = test::good(drive("a.jsonl"));
  EXPECT_TRUE(done->is_complete());
  const auto groups = test::good(groups_of("a.jsonl"));
  ASSERT_EQ(groups->size(), 12U);
  for (const CampaignGroup& group : *groups) {
    ASSERT_EQ(group.trials.size(), 2U);
    EXPECT_NE(group.trials[0].at, group.trials[1].at);
    EXPECT_GT(group.trials[0].until, group.trials[0].at + 5.0);
  }
  EXPECT_EQ((*groups)[1].lasts, "inf");
  EXPECT_EQ((*groups)[1].trials[0].duration, run::kLasting);
}

TEST_F(CampaignTest, WritesTheSameFileWhenItIsStoppedAndGoesOn) {
  campaign_.presets = {"pid"};
  ASSERT_TRUE(drive("whole.jsonl"));
  const auto part = test::good(drive("parts.jsonl", 3, 1));
  EXPECT_FALSE(part->is_complete());
  std::ofstream(path("parts.jsonl"), std::ios::app) << "{\"run\":4,\"sett";  // a process that was killed
  const auto rest = test::good(drive("parts.jsonl", 1000, 1));
  EXPECT_TRUE(rest->is_complete());
  EXPECT_EQ(rest->found, part->driven);
  EXPECT_EQ(content("whole.jsonl"), content("parts.jsonl"));
  campaign_.seed = 7;
  EXPECT_THAT(test::refusal_of(drive("parts.jsonl")), HasSubstr("the plan"));
}

TEST_F(CampaignTest, TellsTheRunThatRepeatsATrial) {
  ASSERT_TRUE(drive("a.jsonl"));
  const auto groups = test::good(groups_of("a.jsonl"));
  int repeated = 0;
  run::Roads roads;
  const std::atomic<bool> stop{false};
  for (const CampaignGroup& group : *groups) {
    const CampaignTrial& trial = *std::min_element(
        group.trials.begin(), group.trials.end(),
        [](const CampaignTrial& a, const CampaignTrial& b) { return a.least_edge < b.least_edge; });
    if (trial.least_edge >= 0.0) continue;
    const Settings settings = settings_of(campaign_.settings, group, trial);
    const auto alone = sweep::drive(settings, roads, stop);
    ASSERT_TRUE(alone && *alone) << command_of(settings);
    EXPECT_EQ((*alone)->total.min_edge_distance, trial.least_edge) << command_of(settings);
    EXPECT_EQ((*alone)->duration, trial.until);
    ++repeated;
  }
  EXPECT_GE(repeated, 2) << "a frozen sensor leads off the road where nobody watches it";
}

TEST_F(CampaignTest, TellsWhereTheCarLeavesTheRoadWithoutAnyFault) {
  campaign_.presets = {"pid"};
  campaign_.tracks = {"hairpins"};
  campaign_.faults = {"slow_solver"};  // which this controller does not have
  campaign_.has_pairs = false;
  campaign_.durations = {1.0};
  campaign_.onsets = 6;
  campaign_.settings.emplace_back("pid.lateral_acceleration_limit_mps2", "11");
  campaign_.settings.emplace_back("pid.proportional_gain", "0.03");
  ASSERT_TRUE(drive("a.jsonl"));
  const auto groups = test::good(groups_of("a.jsonl"));
  ASSERT_EQ(groups->size(), 1U);
  int anyway = 0;
  for (const CampaignTrial& trial : (*groups)[0].trials) anyway += trial.is_off_anyway ? 1 : 0;
  EXPECT_GT(anyway, 0);
  for (const CampaignTrial& trial : (*groups)[0].trials)
    EXPECT_EQ(trial.is_off_anyway, trial.least_edge < 0.0) << trial.at;
}

TEST_F(CampaignTest, GoesOnPastAPlaceThatCannotBeDriven) {
  campaign_.tracks = {"nowhere", "oval"};
  campaign_.presets = {"default"};
  campaign_.has_pairs = false;
  campaign_.durations = {1.0};
  const auto done = test::good(drive("a.jsonl"));
  EXPECT_TRUE(done->is_complete());
  EXPECT_EQ(done->failed, 2U);
  const auto groups = test::good(groups_of("a.jsonl"));
  EXPECT_THAT((*groups)[0].error, HasSubstr("nowhere"));
  EXPECT_EQ((*groups)[2].trials.size(), 2U);
}

}  // namespace
}  // namespace chicane::sweep
