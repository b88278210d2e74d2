// SPDX-License-Identifier: MIT
#include "chicane/live/run_builder.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <string>
#include <thread>
#include <vector>

#include "chicane/protocol/library.hpp"

namespace chicane::live {
namespace {

using namespace std::chrono_literals;

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

/// What became of the newest request.
Result<std::unique_ptr<BuiltRun>> outcome(RunBuilder& builder) {
  for (int i = 0; i < 2000; ++i) {
    if (auto result = builder.take()) return std::move(*result);
    std::this_thread::sleep_for(5ms);
  }
  return fail(ErrorCode::kIo, "nothing was built within 10 s");
}

/// Builds nothing before it is let.
class Gate {
 public:
  Result<std::unique_ptr<run::ClosedLoop>> create(const scenario::Scenario& scenario) {
    std::unique_lock lock(mutex_);
    begun_.push_back(scenario.track);
    changed_.notify_all();
    changed_.wait(lock, [&] { return is_open_; });
    return run::ClosedLoop::create(scenario);
  }
  void wait_for_begin(std::size_t count) {
    std::unique_lock lock(mutex_);
    EXPECT_TRUE(changed_.wait_for(lock, 10s, [&] { return begun_.size() >= count; }));
  }
  void open() {
    const std::lock_guard lock(mutex_);
    is_open_ = true;
    changed_.notify_all();
  }
  std::vector<std::string> begun() {
    const std::lock_guard lock(mutex_);
    return begun_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> begun_;
  bool is_open_ = false;
};

TEST(RunBuilder, MakesARunWithAllThatTakesTime) {
  RunBuilder builder(&describe);
  EXPECT_FALSE(builder.take());
  builder.begin(on("oval"));
  const auto built = outcome(builder);
  ASSERT_TRUE(built) << built.error().message;
  EXPECT_EQ((*built)->loop->track().name(), "oval");
  EXPECT_EQ((*built)->description.track, "oval");
  EXPECT_EQ((*built)->recorded->run.track, "oval");
  EXPECT_EQ((*built)->recorded->scenario.track, "oval");
  ASSERT_EQ((*built)->choices.size(), 1U);
  EXPECT_FALSE(builder.take());  // once
}

TEST(RunBuilder, SaysWhyARunCannotBeBuilt) {
  RunBuilder builder(&describe);
  ChosenRun run = on("oval");
  run.scenario.track = "no/such/road.csv";
  builder.begin(run);
  const auto built = outcome(builder);
  ASSERT_FALSE(built);
  EXPECT_NE(built.error().message.find("no/such/road.csv"), std::string::npos) << built.error().message;
}

TEST(RunBuilder, DoesNotHoldUpWhoeverWishesAndKeepsTheLastOfQuickChoices) {
  Gate gate;
  RunBuilder builder(&describe, [&](const scenario::Scenario& scenario) { return gate.create(scenario); });
  builder.begin(on("oval"));
  gate.wait_for_begin(1);
  builder.begin(on("hairpins"));  // comes back although nothing is built
  builder.begin(on("speedway"));
  EXPECT_FALSE(builder.take());
  gate.open();
  const auto built = outcome(builder);
  ASSERT_TRUE(built) << built.error().message;
  EXPECT_EQ((*built)->loop->track().name(), "speedway");
  EXPECT_EQ(gate.begun(), (std::vector<std::string>{"oval", "speedway"}));  // one that waited was replaced
  EXPECT_FALSE(builder.take());                                             // the first is thrown away
}

}  // namespace
}  // namespace chicane::live
