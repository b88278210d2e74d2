// SPDX-License-Identifier: MIT
#include "chicane/live/run_builder.hpp"

#include <gtest/gtest.h>

#include <string>

#include "chicane/protocol/library.hpp"

namespace chicane::live {
namespace {

ChosenRun on(const std::string& track) {
  const auto scenario = protocol::compose({.scenario_file = {}, .settings = {{"track", track}}});
  EXPECT_TRUE(scenario);
  return {.scenario = *scenario, .choices = {{.name = "track", .value = track, .starts_anew = true}}};
}

protocol::Run describe(const run::ClosedLoop& loop) {
  protocol::Run run;
  run.track = loop.track().name();
  return run;
}

TEST(RunBuilder, MakesARunWithAllThatTakesTime) {
  const auto built = build_run(on("oval"), &describe);
  ASSERT_TRUE(built) << built.error().message;
  EXPECT_EQ((*built)->loop->track().name(), "oval");
  EXPECT_EQ((*built)->description.track, "oval");
  EXPECT_EQ((*built)->recorded->run.track, "oval");
  EXPECT_EQ((*built)->recorded->scenario.track, "oval");
  ASSERT_EQ((*built)->choices.size(), 1U);
}

TEST(RunBuilder, SaysWhyARunCannotBeBuilt) {
  ChosenRun run = on("oval");
  run.scenario.track = "no/such/road.csv";
  const auto built = build_run(run, &describe);
  ASSERT_FALSE(built);
  EXPECT_NE(built.error().message.find("no/such/road.csv"), std::string::npos) << built.error().message;
}

}  // namespace
}  // namespace chicane::live
