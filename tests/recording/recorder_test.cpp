// SPDX-License-Identifier: MIT
#include "chicane/recording/recorder.hpp"

#include <sys/wait.h>

#include <csignal>

#include "chicane/base/math.hpp"
#include "chicane/recording/replay.hpp"
#include "chicane/telemetry/mcap.hpp"
#include "support/chicane_test.hpp"
#include "support/own_controller.hpp"
#include "support/roads.hpp"
#include "support/runs.hpp"
#include "telemetry/sample_mcap.hpp"

namespace chicane::recording {
namespace {

using telemetry::TemporaryFile;

std::unique_ptr<run::ClosedLoop> short_run(test::Settings settings) {
  settings.insert(settings.begin(), {{"laps", "1"}, {"time_limit_s", "12"}});
  return test::loop_of(test::scenario_of(settings));
}

RecorderOptions recording(const run::ClosedLoop& loop, const std::string& path) {
  RecorderOptions options{.path = path, .run = {}, .scenario = loop.scenario(), .may_wait = true};
  options.run.track = loop.track().name();
  return options;
}

RecorderReport record(run::ClosedLoop& loop, const std::string& path) {
  auto recorder = Recorder::create(recording(loop, path));
  EXPECT_TRUE(recorder);
  static_cast<void>(run::run_closed_loop(
      loop, {.on_frame = [&](const telemetry::Frame& frame) { (*recorder)->record(frame); },
             .on_lap = [&](const telemetry::CompletedLap& lap) { (*recorder)->record(lap); },
             .on_change = [&](const telemetry::Change& change) { (*recorder)->record(change); }}));
  const Result<RecorderReport> report = (*recorder)->finish();
  EXPECT_TRUE(report);
  return report.value_or(RecorderReport{});
}

class RecordedController : public ::testing::TestWithParam<const char*> {};

TEST_P(RecordedController, ComesOutTheSameToTheLastBit) {
  for (const char* car : {"udacity", "road-car"}) {
    const TemporaryFile file;
    const auto loop = short_run({{"car", car},
                                 {"controller", GetParam()},
                                 {"sensor.position_noise_m", "0.05"},
                                 {"vehicle.steer_limit_deg", "23.3"}});
    const RecorderReport recorded = record(*loop, file.path());
    EXPECT_GT(recorded.frames, 100U);
    EXPECT_EQ(recorded.left_out, 0U);
    const Result<ReplayReport> replayed = test::good(verify_recording(file.path()));
    EXPECT_TRUE(replayed->is_verified()) << car << " " << replayed->first_difference.value_or(0);
    EXPECT_EQ(replayed->steps, recorded.frames);
    EXPECT_TRUE(replayed->is_complete);
    EXPECT_EQ(replayed->controller, GetParam());
  }
}
INSTANTIATE_TEST_SUITE_P(Controllers, RecordedController,
                         ::testing::Values("tracking-mpc", "cubic-mpc", "pid", "pure-pursuit", "stanley"),
                         [](const auto& parameter) {
                           std::string name = parameter.param;
                           std::erase(name, '-');
                           return name;
                         });

// Only who has the parts can compute it again.
TEST(Replay, IsByTheControllerAndOnTheTrackOfOnesOwn) {
  const TemporaryFile file;
  run::Factories parts(test::make_own_controller);
  parts.track = [](const scenario::Scenario&) -> Result<road::Track> {
    return test::circle_road(80.0, 50, 5.0, 5.0);
  };
  const auto loop =
      test::good(run::ClosedLoop::create(test::scenario_of({{"laps", "0"}, {"time_limit_s", "8"}}), parts));
  EXPECT_EQ(record(**loop, file.path()).frames, 200U);
  const Result<ReplayReport> replayed = test::good(verify_recording(file.path(), parts));
  EXPECT_TRUE(replayed->is_verified()) << replayed->first_difference.value_or(0);
  EXPECT_FALSE(verify_recording(file.path())->is_verified());
}

// Delay and steering that a run finds out about its car are found again, and taken up at the same steps.
TEST(Recorder, HasARunThatIdentifiesItsCar) {
  const TemporaryFile file;
  const auto loop = short_run({{"car", "road-car"}, {"time_limit_s", "20"}});
  loop->set_fault(
      {.fault = *sim::fault_named("steering_offset"), .at = 0.0, .duration = 60.0, .strength = 2.0});
  const RecorderReport recorded = record(*loop, file.path());
  EXPECT_GT(loop->summary().learned.offset.value, degrees_to_radians(1.0));
  const Result<ReplayReport> replayed = test::good(verify_recording(file.path()));
  EXPECT_EQ(replayed->identical, recorded.frames);
  EXPECT_EQ(replayed->different, 0U);
}

// The lap is planned again from what the controller had learned, and takes effect at the same step.
TEST(Recorder, HasARaceWithALearnedRoadAndGrip) {
  for (const char* road : {"waypoints", "track"}) {
    const TemporaryFile file;
    const auto loop = short_run({{"preset", "race"},
                                 {"track", "oval"},
                                 {"guard.road", road},
                                 {"tracking_mpc.learn_grip", "true"},
                                 {"plant_options.friction_scale", "0.85"},
                                 {"laps", "4"},
                                 {"time_limit_s", "45"}});
    const RecorderReport recorded = record(*loop, file.path());
    const Result<ReplayReport> replayed = test::good(verify_recording(file.path()));
    EXPECT_EQ(replayed->identical, recorded.frames) << road;
    EXPECT_EQ(replayed->different, 0U) << road;
  }
}

TEST(Recorder, KeepsAScenarioThatIsAllDefaultsWhole) {
  const TemporaryFile file;
  ASSERT_TRUE((*Recorder::create({.path = file.path(), .run = {}, .scenario = {}}))->finish());
  std::string scenario;
  ASSERT_TRUE(telemetry::read_mcap(
      file.path(), {.on_attachment = [&](std::string_view, std::string_view bytes) { scenario = bytes; }}));
  EXPECT_NE(scenario.find("control_period_ms: 40\n"), std::string::npos) << scenario;
}

// It said "0 of 0 (0.000 %)".
TEST(Replay, ARecordingWithoutStepsIsRefusedInWords) {
  const TemporaryFile file;
  ASSERT_TRUE((*Recorder::create({.path = file.path(), .run = {}, .scenario = {}}))->finish());
  Result<ReplayReport> replayed = verify_recording(file.path());
  ASSERT_FALSE(replayed);
  EXPECT_EQ(replayed.error().code, ErrorCode::kParse);
  EXPECT_EQ(replayed.error().message,
            file.path() + ": steps: got none, expected a recording with control steps to compute again");

  const TemporaryFile damaged;
  record(*short_run({{"controller", "pid"}}), damaged.path());
  std::string bytes = damaged.bytes();
  const std::size_t first_chunk = bytes.find("/chicane/step", bytes.find("scenario.yaml"));
  ASSERT_NE(first_chunk, std::string::npos);
  for (std::size_t i = first_chunk; i < bytes.size(); i += 50) bytes[i] = static_cast<char>(bytes[i] ^ 1);
  damaged.replace(bytes);
  replayed = verify_recording(damaged.path());
  ASSERT_FALSE(replayed);
  EXPECT_NE(replayed.error().message.find("steps: got none"), std::string::npos) << replayed.error().message;
}

/// Of the recording with the step messages as `change` leaves them; it may return false: left out.
template <class Change>
Result<ReplayReport> verify_rewritten(const TemporaryFile& from, Change change) {
  const TemporaryFile to;
  auto writer = test::good(telemetry::McapWriter::create(to.path(), "test"));
  const std::uint16_t channel = (*writer)->add_channel("/chicane/step", "chicane_msgs/msg/Step", "");
  const auto read = telemetry::read_mcap(
      from.path(),
      {.on_message =
           [&](const telemetry::McapMessage& message) {
             if (message.channel.topic != "/chicane/step") return;
             std::string bytes(message.bytes);
             if (change(message.sequence, bytes)) {
               EXPECT_TRUE((*writer)->write(channel, message.log_time, message.publish_time, bytes));
             }
           },
       .on_attachment =
           [&](std::string_view name, std::string_view bytes) {
             EXPECT_TRUE((*writer)->add_attachment(name, "application/yaml", bytes));
           }});
  EXPECT_TRUE(read);
  writer->reset();
  return verify_recording(to.path());
}

TEST(Replay, DetectsOneFlippedBitOfACommandAndNamesItsCycle) {
  const TemporaryFile file;
  record(*short_run({{"controller", "tracking-mpc"}}), file.path());
  const Result<ReplayReport> replayed = verify_rewritten(file, [](std::uint32_t cycle, std::string& bytes) {
    if (cycle == 77) bytes[4 + 9 * 8] = static_cast<char>(bytes[4 + 9 * 8] ^ 1);  // the command's steering
    return true;
  });
  ASSERT_TRUE(replayed) << replayed.error().message;
  EXPECT_FALSE(replayed->is_verified());
  EXPECT_EQ(replayed->different, 1U);
  EXPECT_EQ(replayed->first_difference, 77U);
}

TEST(Replay, CallsStepsBehindAMissingOneUnknownNotIdentical) {
  const TemporaryFile file;
  record(*short_run({{"controller", "pid"}}), file.path());
  const Result<ReplayReport> replayed =
      verify_rewritten(file, [](std::uint32_t cycle, std::string&) { return cycle != 50; });
  ASSERT_TRUE(replayed) << replayed.error().message;
  EXPECT_FALSE(replayed->is_verified());
  EXPECT_EQ(replayed->identical, 50U);
  EXPECT_EQ(replayed->unknown, replayed->steps - 50U);
  EXPECT_FALSE(replayed->first_difference);
}

TEST(Replay, RefusesARecordingOfOthersInWords) {
  const TemporaryFile file;
  telemetry::write_sample(file.path());
  const Result<ReplayReport> replayed = verify_recording(file.path());
  ASSERT_FALSE(replayed);
  EXPECT_EQ(replayed.error().code, ErrorCode::kParse);
  EXPECT_NE(replayed.error().message.find("expected a recording of chicane"), std::string::npos);
}

TEST(Recorder, HoldsEveryTopicAndTimesThatNeverGoBackWhenTheRunStartsAnew) {
  const TemporaryFile file;
  const auto loop = short_run({{"controller", "pid"}});
  auto recorder = test::good(Recorder::create(recording(*loop, file.path())));
  for (int run = 0; run < 2; ++run) {
    test::drive_cycles(*loop, 30, [&](const telemetry::Frame& frame) { (*recorder)->record(frame); });
    loop->restart();
  }
  ASSERT_TRUE((*recorder)->finish());
  std::map<std::string, int> counts;
  std::uint64_t last = 0;
  const auto read = telemetry::read_mcap(file.path(), {.on_message = [&](const auto& message) {
                                           ++counts[message.channel.topic];
                                           EXPECT_GE(message.log_time, last);
                                           last = message.log_time;
                                         }});
  ASSERT_TRUE(read);
  for (const protocol::RosTopic& topic : protocol::ros_topics()) {
    using enum protocol::Cadence;
    const bool is_unknown =
        topic.name == "/chicane/limit" || topic.name == "/track/racing_line";  // not given
    const bool is_rare =
        topic.cadence == kLap || topic.cadence == kEvent || is_unknown;  // none in this second
    EXPECT_EQ(counts[std::string(topic.name)], topic.cadence == kFrame ? 60 : is_rare ? 0 : 1) << topic.name;
  }
  EXPECT_EQ(counts["/chicane/step"], 60);
  const Result<ReplayReport> replayed = test::good(verify_recording(file.path()));
  EXPECT_TRUE(replayed->is_verified());
}

TEST(Recorder, RecordsFaultsSoThatTheyComeOutTheSame) {
  const TemporaryFile file;
  scenario::Scenario scenario = test::scenario_of();
  for (const char* name : {"gps_noise", "slow_solver", "link_lost"}) {
    scenario.faults.push_back(
        sim::default_event(*sim::fault_named(name), 0.5 + static_cast<double>(scenario.faults.size())));
  }
  const auto loop = test::loop_of(scenario);
  auto recorder = test::good(Recorder::create(recording(*loop, file.path())));
  test::drive_cycles(*loop, 100, [&](const telemetry::Frame& frame) { (*recorder)->record(frame); });
  ASSERT_TRUE((*recorder)->finish());
  const Result<ReplayReport> replayed = test::good(verify_recording(file.path()));
  EXPECT_TRUE(replayed->is_verified()) << replayed->different << " differ";
}

/// Messages of a recording by topic.
std::map<std::string, int> counts_of(const TemporaryFile& file) {
  std::map<std::string, int> counts;
  EXPECT_TRUE(telemetry::read_mcap(
      file.path(), {.on_message = [&](const auto& message) { ++counts[message.channel.topic]; }}));
  return counts;
}

TEST(Recorder, WritesEachLapOnce) {
  const TemporaryFile file;
  const auto loop = short_run({{"controller", "pid"}});
  auto recorder = test::good(Recorder::create(recording(*loop, file.path())));
  while (!loop->advance()) {
  }
  telemetry::Frame frame = loop->frame();
  for (const int lap : {0, 0, 1, 1, 2, 2, 0, 1}) {  // started anew after the second
    if (lap > frame.completed_lap.lap) (*recorder)->record(telemetry::CompletedLap{.lap = lap});
    frame.completed_lap.lap = lap;
    (*recorder)->record(frame);
  }
  ASSERT_TRUE((*recorder)->finish());
  EXPECT_EQ(counts_of(file)["/chicane/lap"], 3);
}

TEST(Recorder, LeavesFramesOutRatherThanLetTheRunWait) {
  const TemporaryFile file;
  const auto loop = short_run({{"controller", "pid"}});
  RecorderOptions options = recording(*loop, file.path());
  options.may_wait = false;
  auto recorder = test::good(Recorder::create(std::move(options)));
  while (!loop->advance()) {
  }
  constexpr std::uint64_t kFrames = 5000;
  for (std::uint64_t i = 0; i < kFrames; ++i) (*recorder)->record(loop->frame());
  const Result<RecorderReport> report = test::good((*recorder)->finish());
  EXPECT_EQ(report->frames + report->left_out, kFrames);
}

TEST(Recorder, LeavesAFileThatVerifiesWhenItIsKilled) {
  for (int round = 0; round < 5; ++round) {
    const TemporaryFile file;
    const auto loop = short_run({{"controller", "pid"}});
    std::array<int, 2> ends{};
    ASSERT_EQ(::pipe(ends.data()), 0);
    const ::pid_t child = ::fork();
    if (child == 0) {
      auto recorder = Recorder::create(recording(*loop, file.path()));
      loop->drive_on();
      while (true) {
        if (!loop->advance()) continue;
        (*recorder)->record(loop->frame());
        if (::write(ends[1], "x", 1) < 0) ::_exit(1);
      }
    }
    ::close(ends[1]);
    std::array<char, 100> steps{};
    for (int i = 0; i < 20 * (round + 1); ++i) ASSERT_GT(::read(ends[0], steps.data(), steps.size()), 0);
    ::kill(child, SIGKILL);
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    ::close(ends[0]);
    const Result<ReplayReport> replayed = verify_recording(file.path());
    if (!replayed) {  // killed before the first chunk was written
      EXPECT_NE(replayed.error().message.find("steps: got none before the file's end"), std::string::npos)
          << replayed.error().message;
      continue;
    }
    EXPECT_EQ(replayed->identical, replayed->steps);
    EXPECT_EQ(replayed->damaged, 0U);
    EXPECT_FALSE(replayed->is_complete);
  }
}

}  // namespace
}  // namespace chicane::recording
