// SPDX-License-Identifier: MIT
#include "chicane/recording/shadow_run.hpp"

#include "chicane/protocol/step_codec.hpp"
#include "chicane/recording/recorder.hpp"
#include "chicane/recording/replay.hpp"
#include "chicane/telemetry/mcap.hpp"
#include "support/chicane_test.hpp"
#include "support/runs.hpp"
#include "telemetry/sample_mcap.hpp"

namespace chicane::recording {
namespace {

using telemetry::TemporaryFile;

/// Step messages of a recording, in order: every bit of what was measured, sent and decided.
std::vector<std::string> steps_of(const std::string& file) {
  std::vector<std::string> steps;
  EXPECT_TRUE(telemetry::read_mcap(file, {.on_message = [&](const telemetry::McapMessage& message) {
                                     if (message.channel.topic == protocol::kStepTopic)
                                       steps.emplace_back(message.bytes);
                                   }}));
  return steps;
}

/// A recording in the making.
class Recording {
 public:
  explicit Recording(const std::string& file) : file_{file} {}
  Result<void> begin(const run::ClosedLoop& loop) {
    RecorderOptions options;
    options.path = file_;
    options.scenario = loop.scenario();
    options.may_wait = true;
    auto recorder = Recorder::create(options);
    if (!recorder) return fail(recorder.error());
    recorder_ = std::move(*recorder);
    return {};
  }
  Recorder& operator*() { return *recorder_; }
  BranchHooks hooks() {
    return {.on_begin = [this](const run::ClosedLoop& loop) { return begin(loop); },
            .on_change = [this](const telemetry::Change& change) { recorder_->record(change); },
            .on_frame = [this](const telemetry::Frame& frame) { recorder_->record(frame); }};
  }

 private:
  std::string file_;
  std::unique_ptr<Recorder> recorder_;
};

std::unique_ptr<run::ClosedLoop> short_run(test::Settings settings = {}) {
  settings.insert(settings.begin(), {{"laps", "1"}, {"sensor.position_noise_m", "0.05"}});
  return test::loop_of(test::scenario_of(settings));
}

/// `cycles` control steps; with a `budget` [s] as in real time.
void record(run::ClosedLoop& loop, const std::string& file, int cycles, double budget = 0.0) {
  Recording recording(file);
  ASSERT_TRUE(recording.begin(loop));
  for (int cycle = 0; cycle < cycles;) {
    if (loop.is_control_due() && cycle == cycles / 3) {
      const telemetry::Change change{.cycle = loop.cycle(),
                                     .time = loop.time(),
                                     .name = std::string_view("plant_options.friction_scale"),
                                     .value = std::string_view("0.9")};
      loop.apply(change);
      (*recording).record(change);
    }
    if (!loop.advance(budget)) continue;
    (*recording).record(loop.frame());
    ++cycle;
  }
  ASSERT_TRUE((*recording).finish());
}

Result<BranchReport> branch(const TemporaryFile& from, const std::string& to, BranchOptions options) {
  options.log = from.path();
  Recording recording(to);
  auto report = branch_recording(options, recording.hooks());
  const bool is_kept = !report || (*recording).finish();
  EXPECT_TRUE(is_kept);
  return report;
}

class BranchTest : public testing::Test {
 protected:
  ~BranchTest() override { std::filesystem::remove(branched_); }
  TemporaryFile file_;
  std::string branched_ = file_.path() + ".branch";
};

TEST_F(BranchTest, WithoutAChangeIsTheSameRunToTheLastBit) {
  record(*short_run(), file_.path(), 200);
  const auto report = test::good(branch(file_, branched_, {.at = 4.0}));
  EXPECT_FALSE(report->first_difference);
  EXPECT_EQ(report->cycle, 100U);
  EXPECT_EQ(report->steps_before, 100U);
  const auto was = steps_of(file_.path()), is = steps_of(branched_);
  ASSERT_EQ(was.size(), 200U);
  ASSERT_EQ(is.size(), was.size());
  for (std::size_t i = 0; i < was.size(); ++i) {
    const auto then = protocol::decode_step(was[i]), now = protocol::decode_step(is[i]);
    ASSERT_TRUE(then && now);
    auto same = *now;
    same.step_time = then->step_time;  // the one thing that the clock says
    EXPECT_EQ(same.command.steer, then->command.steer) << i;
    EXPECT_EQ(same.command.throttle, then->command.throttle) << i;
    EXPECT_EQ(same.measurement.x, then->measurement.x) << i;
    EXPECT_EQ(same.measurement.y, then->measurement.y) << i;
  }
  EXPECT_EQ(report->branched.duration, report->recorded.duration);
  EXPECT_EQ(report->branched.max_lateral_error, report->recorded.max_lateral_error);
  EXPECT_EQ(report->branched.min_edge_distance, report->recorded.min_edge_distance);
  EXPECT_EQ(report->branched.mean_speed, report->recorded.mean_speed);
}

TEST_F(BranchTest, WithAChangeGoesOnOtherwiseAndCanBeVerified) {
  record(*short_run(), file_.path(), 200);
  const auto report = test::good(branch(
      file_, branched_, {.at = 5.0, .settings = {{"tracking_mpc.speed_limit_mps", "6"}}, .duration = 12.0}));
  EXPECT_FALSE(report->first_difference);
  EXPECT_NEAR(report->branched.duration, 12.0, 0.05);
  EXPECT_LT(report->recorded.duration, 3.0) << "to the end of the recording";
  EXPECT_LT(report->branched.mean_speed, report->recorded.mean_speed);
  const auto was = steps_of(file_.path()), is = steps_of(branched_);
  EXPECT_EQ(is.size(), 125U + 301U);
  const auto verified = test::good(verify_recording(branched_));
  EXPECT_TRUE(verified->is_verified()) << verified->first_difference.value_or(0);
}

TEST_F(BranchTest, OfARunWhoseDeadlinesWereSpentStartsFromTheSameBits) {
  record(*short_run(), file_.path(), 200, 30e-6);
  std::uint64_t late = 0;
  for (const std::string& step : steps_of(file_.path()))
    late += protocol::decode_step(step)->deadline_spent_at > 0;
  EXPECT_GT(late, 0U) << "too fast a machine for this test";
  const auto report = test::good(branch(file_, branched_, {.at = 6.0}));
  EXPECT_FALSE(report->first_difference);
}

TEST_F(BranchTest, OfARunWithFaultsHasTheSameFaultsAndTakesAnother) {
  const auto loop = short_run();
  {
    Recording recording(file_.path());
    ASSERT_TRUE(recording.begin(*loop));
    std::uint32_t told = 0;
    for (int cycle = 0; cycle < 200;) {
      if (loop->is_control_due() && cycle == 50) {
        const telemetry::Change change{.cycle = 50, .time = 2.0, .name = "fault.half_grip", .value = "true"};
        loop->apply(change);
        (*recording).record(change);
      }
      if (!loop->advance()) continue;
      (*recording).record(loop->frame());
      const std::uint32_t ended = std::exchange(told, loop->frame().active_faults) & ~told;
      if (ended != 0U) {  // by itself, told after the step that showed it
        (*recording)
            .record(telemetry::Change{
                .cycle = loop->cycle(), .time = loop->time(), .name = "fault.half_grip", .value = "false"});
      }
      ++cycle;
    }
    ASSERT_TRUE((*recording).finish());
  }
  const auto same = test::good(branch(file_, branched_, {.at = 3.0}));
  EXPECT_FALSE(same->first_difference);
  EXPECT_EQ(same->branched.max_lateral_error, same->recorded.max_lateral_error);
  std::filesystem::remove(branched_);
  const auto other =
      test::good(branch(file_, branched_, {.at = 3.0, .settings = {{"fault.link_lost", "true"}}}));
  EXPECT_NE(other->branched.mean_speed, other->recorded.mean_speed);
}

TEST_F(BranchTest, FollowsARunThatStartedAnew) {
  const auto loop = short_run();
  {
    Recording recording(file_.path());
    ASSERT_TRUE(recording.begin(*loop));
    for (int run = 0; run < 2; ++run) {
      for (int cycle = 0; cycle < 50;) {
        if (!loop->advance()) continue;
        (*recording).record(loop->frame());
        ++cycle;
      }
      loop->restart();
    }
    ASSERT_TRUE((*recording).finish());
  }
  const auto report = test::good(branch(file_, branched_, {.at = 3.0}));
  EXPECT_FALSE(report->first_difference);
  EXPECT_EQ(report->cycle, 25U);
  EXPECT_EQ(report->steps_before, 75U);
}

TEST_F(BranchTest, SaysWhenTheRecordingDoesNotComeOutTheSame) {
  const auto other = short_run({{"seed", "2"}});
  const auto loop = short_run();
  Recording recording(file_.path());
  ASSERT_TRUE(recording.begin(*loop));
  for (int cycle = 0; cycle < 50;) {
    if (!other->advance()) continue;
    (*recording).record(other->frame());  // not what the recorded scenario gives
    ++cycle;
  }
  ASSERT_TRUE((*recording).finish());
  const auto report = test::good(branch(file_, branched_, {.at = 1.0}));
  EXPECT_EQ(report->first_difference, 0U);
}

TEST_F(BranchTest, RefusesWhatCannotBeInWords) {
  record(*short_run({{"controller", "pid"}}), file_.path(), 50);
  const auto message = [&](BranchOptions options) {
    std::filesystem::remove(branched_);
    const auto report = branch(file_, branched_, std::move(options));
    return report ? "" : report.error().message;
  };
  EXPECT_THAT(message({.at = 60.0}), HasSubstr("--branch-at: got 60, expected a moment in [0, 1.96] s"));
  EXPECT_THAT(message({.at = 1.0, .settings = {{"pid.gain", "1"}}}), HasSubstr("pid.gain"));
  EXPECT_THAT(message({.at = 1.0, .settings = {{"latency_ms", "900"}}}), HasSubstr("expected a number in"));
  EXPECT_THAT(message({.at = 1.0, .settings = {{"track", "speedway"}}}), HasSubstr("while the run goes on"));
}

TEST_F(BranchTest, DrivesBothFuturesOnWhereTheRecordingEnds) {
  record(*short_run(), file_.path(), 200);
  std::map<bool, std::vector<double>> distances;
  std::map<bool, std::vector<double>> speeds;
  const BranchHooks hooks{.on_future = [&](const FutureStep& step) {
    distances[step.is_branch].push_back(step.distance);
    speeds[step.is_branch].push_back(step.frame.measurement.speed);
  }};
  const auto report = test::good(
      branch_recording({.log = file_.path(), .at = 4.0, .more_laps = 1, .drives_both = true}, hooks));
  EXPECT_FALSE(report->first_difference);
  EXPECT_DOUBLE_EQ(report->known_until, 199 * 0.04);
  EXPECT_EQ(speeds[false], speeds[true]) << "nothing was changed: the same, to the last bit";
  const Future &was = report->recorded, &is = report->branched;
  ASSERT_EQ(was.lap_times.size(), 1U);
  EXPECT_EQ(was.lap_times, is.lap_times);
  ASSERT_EQ(is.passages.size(), 3U) << "the run begins on the line";
  EXPECT_EQ(is.passages.back().lap, 1);
  EXPECT_EQ(is.passages.back().sector, 3);
  EXPECT_NEAR(4.0 + is.passages.back().time, is.lap_times.front(), 0.02)
      << "a lap ends with its third sector";
  EXPECT_GT(distances[true].back(), distances[true].front() + 1000.0);
}

TEST_F(BranchTest, BeginsWhereTheRecordingEndsAndTellsTheDifference) {
  record(*short_run(), file_.path(), 200);
  const auto report = test::good(branch_recording({.log = file_.path(),
                                                   .at = 1e9,
                                                   .settings = {{"tracking_mpc.speed_limit_mps", "8"}},
                                                   .duration = 10.0,
                                                   .drives_both = true},
                                                  {}));
  EXPECT_EQ(report->cycle, 200U);
  EXPECT_NEAR(report->recorded.duration, 10.0, 0.05);
  EXPECT_NEAR(report->branched.duration, 10.0, 0.05);
  EXPECT_LT(report->branched.mean_speed, report->recorded.mean_speed - 3.0);
}

TEST_F(BranchTest, EndsWhenNobodyWantsItAnyMore) {
  record(*short_run(), file_.path(), 50);
  const BranchHooks hooks{.go_on = [](double time) { return time < 1.0; }};
  EXPECT_THAT(test::refusal_of(branch_recording({.log = file_.path(), .at = 0.5, .duration = 100.0}, hooks)),
              HasSubstr("given up"));
}

}  // namespace
}  // namespace chicane::recording
