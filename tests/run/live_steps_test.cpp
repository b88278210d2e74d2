// SPDX-License-Identifier: MIT
#include "chicane/run/run_steps.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "chicane/protocol/library.hpp"

namespace chicane::run {
namespace {

class SteppedRun : public testing::Test {
 protected:
  void SetUp() override {
    const auto scenario =
        protocol::compose({.scenario_file = {}, .settings = {{"preset", "pid"}, {"track", "oval"}}});
    ASSERT_TRUE(scenario);
    loop = std::move(*ClosedLoop::create(*scenario));
    hooks.on_frame = [this](const telemetry::Frame& frame) { cycles.push_back(frame.cycle); };
    hooks.on_change = [this](const telemetry::Change& change) { changes.push_back(change); };
    steps = std::make_unique<LiveSteps>(*loop, 0.0, controls, hooks);
  }
  void change(const std::string& key, const std::string& value) {
    controls.settings.push(*read_setting({.name = key, .value = value}));
  }

  RunControls controls;
  RunHooks hooks;
  std::unique_ptr<ClosedLoop> loop;
  std::unique_ptr<LiveSteps> steps;
  std::vector<std::uint64_t> cycles;
  std::vector<telemetry::Change> changes;
};

TEST_F(SteppedRun, StandsStillBetweenTwoControlCycles) {
  EXPECT_TRUE(steps->is_unseen());
  steps->one_cycle();
  EXPECT_FALSE(steps->is_unseen());
  EXPECT_TRUE(loop->is_control_due());
  EXPECT_EQ(cycles, (std::vector<std::uint64_t>{0}));
  EXPECT_TRUE(steps->advance());
  EXPECT_FALSE(steps->advance()) << "physics has smaller steps";
  steps->finish_cycle();
  EXPECT_TRUE(loop->is_control_due());
  EXPECT_EQ(cycles, (std::vector<std::uint64_t>{0, 1}));
}

TEST_F(SteppedRun, TakesChangesUpBeforeTheNextControlCycleOnly) {
  steps->one_cycle();
  EXPECT_TRUE(steps->advance());
  change("latency_ms", "60");
  EXPECT_FALSE(steps->advance());
  EXPECT_TRUE(changes.empty());
  steps->finish_cycle();
  EXPECT_TRUE(steps->advance());
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].cycle, 2U);
  EXPECT_EQ(loop->scenario().latency, 0.06);
}

TEST_F(SteppedRun, DoesNothingMoreOnceAChangeStartsItAnew) {
  change("latency_ms", "60");
  ASSERT_TRUE(controls.settings.push(
      {.change = {.name = "track", .value = "lakeside", .starts_anew = true}, .action = {}}));
  change("latency_ms", "80");
  EXPECT_FALSE(steps->advance());
  EXPECT_TRUE(steps->is_to_start_anew());
  steps->one_cycle();
  EXPECT_TRUE(cycles.empty());
  EXPECT_EQ(changes.size(), 1U);
  EXPECT_EQ(controls.settings.front()->change.name.view(), "track");
}

TEST_F(SteppedRun, GoesBackToTheStartWhenAskedOnce) {
  steps->one_cycle();
  EXPECT_FALSE(steps->restart_if_wanted());
  controls.wants_restart = true;
  EXPECT_TRUE(steps->restart_if_wanted());
  EXPECT_TRUE(steps->is_unseen());
  EXPECT_EQ(loop->time(), 0.0);
  EXPECT_FALSE(steps->restart_if_wanted());
}

TEST_F(SteppedRun, TakesEachStepThatWasAskedForOnce) {
  EXPECT_FALSE(steps->take_step());
  controls.steps = 2;
  EXPECT_TRUE(steps->take_step());
  EXPECT_TRUE(steps->take_step());
  EXPECT_FALSE(steps->take_step());
}

}  // namespace
}  // namespace chicane::run
