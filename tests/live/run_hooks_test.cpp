// SPDX-License-Identifier: MIT
#include "chicane/live/run_hooks.hpp"

#include <gtest/gtest.h>

#include <variant>

#include "chicane/protocol/library.hpp"

namespace chicane::live {
namespace {

TEST(RunHooks, WithoutARecorderNothingIsCalledAndNewsStay) {
  RunLimit limit;
  const LiveHooks hooks = recording_hooks(nullptr, limit);
  EXPECT_FALSE(hooks.on_frame || hooks.on_lap || hooks.on_change || hooks.say);
  record_news(nullptr, limit);
  EXPECT_EQ(limit.news(), nullptr);
}

TEST(RunHooks, AJournalKnowsWhatTheHooksWereTold) {
  Journal journal;
  journal.begin(protocol::compose({}).value());
  const LiveHooks hooks = journal_hooks(journal);
  telemetry::Frame frame;
  frame.begins = true;
  hooks.on_frame(frame);
  hooks.on_change({.cycle = 1, .time = 0.04, .name = "latency_ms", .value = "60"});
  const auto history = journal.history();
  ASSERT_TRUE(history) << history.error().message;
  int steps = 0, changes = 0;
  const Result<void> told = history->events([&](const recording::RecordedEvent& event) -> Result<void> {
    if (std::holds_alternative<recording::RecordedStep>(event)) ++steps;
    if (const auto* change = std::get_if<telemetry::Change>(&event)) {
      ++changes;
      EXPECT_EQ(change->value.view(), "60");
    }
    return {};
  });
  ASSERT_TRUE(told) << told.error().message;
  EXPECT_EQ(steps, 1);
  EXPECT_EQ(changes, 1);
}

}  // namespace
}  // namespace chicane::live
