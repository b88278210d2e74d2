// SPDX-License-Identifier: MIT
#include "chicane/recording/replay.hpp"

#include "chicane/recording/recorder.hpp"
#include "support/chicane_test.hpp"
#include "support/runs.hpp"
#include "telemetry/sample_mcap.hpp"

namespace chicane::recording {
namespace {

using telemetry::TemporaryFile;

/// Two seconds of the given run with a change of a setting after the first.
std::size_t record(const std::string& path, const std::string& controller = "pid") {
  const auto loop = test::loop_of(test::scenario_of({{"controller", controller}, {"laps", "1"}}));
  RecorderOptions options;
  options.path = path;
  options.run.track = loop->track().name();
  options.scenario = loop->scenario();
  options.may_wait = true;
  const auto recorder = Recorder::create(options);
  EXPECT_TRUE(recorder);
  std::size_t steps = 0;
  while (steps < 50) {
    if (!loop->advance()) continue;
    (*recorder)->record(loop->frame());
    ++steps;
  }
  EXPECT_TRUE((*recorder)->finish());
  return steps;
}

TEST(ReadRecording, VisitsTheScenarioAndThenEachStepInOrder) {
  const TemporaryFile file;
  const std::size_t steps = record(file.path());
  RecordingHead head;
  std::size_t scenarios = 0, read = 0;
  double last = -1.0;
  const auto report = read_recording(file.path(), head, [&](const RecordedEvent& event) -> Result<void> {
    if (const auto* begun = std::get_if<scenario::Scenario>(&event)) {
      EXPECT_EQ(begun->controller, "pid");
      EXPECT_EQ(read, 0U) << "a scenario begins a run";
      ++scenarios;
    }
    if (const auto* step = std::get_if<RecordedStep>(&event)) {
      EXPECT_GT(step->log_time, last);
      last = step->log_time;
      ++read;
    }
    return {};
  });
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(scenarios, 1U);
  EXPECT_EQ(read, steps);
  EXPECT_EQ(head["guard_mode"], "on");
  EXPECT_EQ(head["guard_road"], "track");
  EXPECT_EQ(head["guard_version"], std::to_string(safety::kGuardVersion));
}

TEST(ReadRecording, KnowsWhatTheRunWasBeforeItsFirstEvent) {
  const TemporaryFile file;
  record(file.path());
  RecordingHead head;
  std::string track;
  const auto report = read_recording(file.path(), head, [&](const RecordedEvent&) -> Result<void> {
    if (track.empty()) track = head["track"];
    return {};
  });
  ASSERT_TRUE(report);
  EXPECT_EQ(track, "lakeside");
  EXPECT_EQ(head["no such entry"], "");
}

TEST(ReadRecording, EndsWithTheFailureOfItsVisitor) {
  const TemporaryFile file;
  record(file.path());
  RecordingHead head;
  int visited = 0;
  const auto report = read_recording(file.path(), head, [&](const RecordedEvent&) -> Result<void> {
    if (++visited < 3) return {};
    return fail(ErrorCode::kInvalidArgument, "enough");
  });
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().message, "enough");
  EXPECT_EQ(visited, 3);
}

TEST(ReadRecording, RefusesWhatIsNoRecording) {
  const TemporaryFile file;
  RecordingHead head;
  const auto visit = [](const RecordedEvent&) -> Result<void> { return {}; };
  EXPECT_FALSE(read_recording(file.path() + ".none", head, visit));
  std::ofstream(file.path()) << "a letter";
  const auto report = read_recording(file.path(), head, visit);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kParse);
  EXPECT_THAT(report.error().message, HasSubstr(file.path()));
}

}  // namespace
}  // namespace chicane::recording
