// SPDX-License-Identifier: MIT
#include "chicane/recording/shadow_run.hpp"

#include "chicane/protocol/step_codec.hpp"
#include "chicane/recording/recorder.hpp"
#include "chicane/recording/replay.hpp"
#include "chicane/telemetry/mcap.hpp"
#include "support/chicane_test.hpp"
#include "support/own_controller.hpp"
#include "support/runs.hpp"
#include "telemetry/sample_mcap.hpp"

namespace chicane::recording {
namespace {

scenario::Scenario oval() {
  return test::scenario_of({{"track", "oval"}, {"laps", "0"}, {"sensor.position_noise_m", "0.02"}});
}

/// The events of a run in which settings and faults change, as a recording has them.
std::vector<RecordedEvent> drive(double seconds) {
  const scenario::Scenario scenario = oval();
  std::vector<RecordedEvent> events{scenario};
  const auto loop = std::move(*run::ClosedLoop::create(scenario));
  loop->drive_on();
  const auto change = [&](std::string_view name, std::string_view value) {
    const telemetry::Change made{.cycle = loop->cycle(), .time = loop->time(), .name = name, .value = value};
    loop->apply(made);
    events.emplace_back(made);
  };
  for (int cycle = 0; loop->time() < seconds;) {
    if (loop->is_control_due()) {
      if (cycle == 200) change("tracking_mpc.speed_limit_mps", "20");
      if (cycle == 320) change("fault.half_grip", "+1*0.5");
      if (cycle == 600) change("latency_ms", "60");
      ++cycle;
    }
    if (!loop->advance()) continue;
    const telemetry::Frame& frame = loop->frame();
    RecordedStep recorded;
    recorded.log_time = frame.time;
    recorded.step.cycle = frame.cycle;
    recorded.step.measurement = frame.measurement;
    recorded.step.command = frame.result.command;
    events.emplace_back(recorded);
  }
  return events;
}

RunEvents told(const std::vector<RecordedEvent>& events, std::size_t from) {
  return [&events, from](const auto& visit) -> Result<void> {
    for (std::size_t i = from; i < events.size(); ++i) {
      if (Result<void> taken = visit(events[i]); !taken) return taken;
    }
    return {};
  };
}

/// Stands, and wants a lap to race by.
class WantsLap final : public test::OwnController {
  [[nodiscard]] controller::LapRequest wants_lap() const noexcept override { return {.is_wanted = true}; }
};

/// All that a branch comes to, number by number.
std::vector<double> numbers(const std::vector<RecordedEvent>& events, std::size_t from,
                            const BranchOptions& options, std::uint64_t* steps_before = nullptr) {
  std::vector<double> all;
  const BranchHooks hooks{.on_future = [&](const FutureStep& step) {
    all.insert(all.end(), {step.frame.time, step.distance, step.frame.truth.x, step.frame.truth.y,
                           step.frame.result.command.steer, step.is_branch ? 1.0 : 0.0});
  }};
  const auto report = branch_run(told(events, from), options, hooks);
  EXPECT_TRUE(report) << (report ? "" : report.error().message);
  if (!report) return all;
  EXPECT_FALSE(report->first_difference);
  all.insert(all.end(), {report->at, static_cast<double>(report->cycle), report->known_until,
                         report->recorded.mean_speed, report->branched.mean_speed,
                         static_cast<double>(report->branched.passages.size())});
  if (steps_before != nullptr) *steps_before = report->steps_before;
  return all;
}

TEST(ShadowRun, LeadsToTheSameFuturesFromACopyAsFromTheStart) {
  const auto events = drive(40.0);
  for (const double at : {4.0, 7.98, 13.0, 25.0, 1e9}) {
    SCOPED_TRACE(at);
    BranchOptions options{
        .at = at, .settings = {{"tracking_mpc.speed_limit_mps", "12"}}, .duration = 4.0, .drives_both = true};
    const auto from_start = numbers(events, 0, options);
    ShadowRun run;
    std::size_t followed = 0;
    for (; followed == 0 || (followed < events.size() && run.time() < at - 2.0); ++followed)
      ASSERT_TRUE(run.follow(events[followed]));
    const auto copy = std::make_shared<ShadowRun>();
    ASSERT_TRUE(copy->begin(run));
    options.from = copy;
    std::uint64_t steps_before = 0;
    EXPECT_EQ(numbers(events, followed, options, &steps_before), from_start);
    EXPECT_LE(steps_before, 51U);
  }
}

TEST(ShadowRun, ComesOutTheSameToTheLastBitAndTellsItsLaps) {
  int laps = 0;
  ShadowRun run({.on_lap = [&](const telemetry::CompletedLap&) { ++laps; }});
  EXPECT_FALSE(run.has_begun());
  auto events = drive(40.0);
  for (const RecordedEvent& event : events) ASSERT_TRUE(run.follow(event));
  EXPECT_FALSE(run.first_difference());
  EXPECT_EQ(run.next_cycle(), run.loop().cycle());
  EXPECT_EQ(laps, run.loop().world().lap);
  EXPECT_GE(laps, 1);

  auto& step = std::get<RecordedStep>(events[100]).step;
  step.measurement.x = std::nextafter(step.measurement.x, 1e9);
  ShadowRun other;
  for (std::size_t i = 0; i < 120; ++i) ASSERT_TRUE(other.follow(events[i]));
  EXPECT_EQ(other.first_difference(), step.cycle) << "a bit is a difference";
}

TEST(ShadowRun, DrivesByItselfAndTakesChangesAndFaultsAgain) {
  int steps = 0;
  ShadowRun run({.on_frame = [&](const telemetry::Frame&) { ++steps; }});
  ASSERT_TRUE(run.begin(oval()));
  run.drive([&] { return run.loop().time() >= 4.0 - 1e-9; });
  EXPECT_EQ(steps, 100);
  const auto apply = [&](std::string_view name, std::string_view value) {
    run.apply(*run::read_setting({.name = name, .value = value}));
    run.drive([&, until = run.loop().time() + 0.2] { return run.loop().time() >= until; });
    return run.loop().frame().active_faults != 0U;
  };
  EXPECT_FALSE(apply("fault.half_grip", "false"));
  EXPECT_TRUE(apply("fault.half_grip", "+2*0.9"));
  EXPECT_FALSE(apply("fault.half_grip", "false"));
}

// A recording of the future would not be computed the same again without it.
TEST(ShadowRun, TellsOfALapThatIsPlannedMeanwhile) {
  std::vector<telemetry::Change> changes;
  ShadowRun shadow({.on_change = [&](const telemetry::Change& change) { changes.push_back(change); }});
  shadow.begin(run::ClosedLoop::create(oval(), [](const scenario::Scenario&) {
                 return std::make_unique<WantsLap>();
               }).value());
  shadow.drive([&] { return shadow.loop().time() > run::LapPlanner::kPlanningTime + 1.0; });
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].name.view(), run::LapPlanner::kChange);
}

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
    auto recorder =
        Recorder::create({.path = file_, .run = {}, .scenario = loop.scenario(), .may_wait = true});
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

std::unique_ptr<run::ClosedLoop> noisy_run(test::Settings settings = {}) {
  settings.insert(settings.begin(), {{"laps", "1"}, {"sensor.position_noise_m", "0.05"}});
  return test::loop_of(test::scenario_of(settings));
}

/// `cycles` control steps with a change after a third of them; with a `budget` [s] as in real time.
void record(run::ClosedLoop& loop, const std::string& file, int cycles, double budget = 0.0) {
  Recording recording(file);
  ASSERT_TRUE(recording.begin(loop));
  const auto note = [&](const telemetry::Frame& frame) { (*recording).record(frame); };
  test::drive_cycles(loop, cycles / 3, note, budget);
  while (!loop.is_control_due()) loop.advance();
  const telemetry::Change change{
      .cycle = loop.cycle(), .time = loop.time(), .name = "plant_options.friction_scale", .value = "0.9"};
  loop.apply(change);
  (*recording).record(change);
  test::drive_cycles(loop, cycles - cycles / 3, note, budget);
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
  record(*noisy_run(), file_.path(), 200);
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
  record(*noisy_run(), file_.path(), 200);
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
  record(*noisy_run(), file_.path(), 200, 30e-6);
  std::uint64_t late = 0;
  for (const std::string& step : steps_of(file_.path()))
    late += protocol::decode_step(step)->deadline_spent_at > 0;
  EXPECT_GT(late, 0U) << "too fast a machine for this test";
  const auto report = test::good(branch(file_, branched_, {.at = 6.0}));
  EXPECT_FALSE(report->first_difference);
}

TEST_F(BranchTest, OfARunWithFaultsHasTheSameFaultsAndTakesAnother) {
  const auto loop = noisy_run();
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
  const auto loop = noisy_run();
  {
    Recording recording(file_.path());
    ASSERT_TRUE(recording.begin(*loop));
    for (int run = 0; run < 2; ++run) {
      test::drive_cycles(*loop, 50, [&](const telemetry::Frame& frame) { (*recording).record(frame); });
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
  const auto other = noisy_run({{"seed", "2"}});
  const auto loop = noisy_run();
  Recording recording(file_.path());
  ASSERT_TRUE(recording.begin(*loop));
  // Not what the recorded scenario gives.
  test::drive_cycles(*other, 50, [&](const telemetry::Frame& frame) { (*recording).record(frame); });
  ASSERT_TRUE((*recording).finish());
  const auto report = test::good(branch(file_, branched_, {.at = 1.0}));
  EXPECT_EQ(report->first_difference, 0U);
}

TEST_F(BranchTest, RefusesWhatCannotBeInWords) {
  record(*noisy_run({{"controller", "pid"}}), file_.path(), 50);
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
  record(*noisy_run(), file_.path(), 200);
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
  record(*noisy_run(), file_.path(), 200);
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
  record(*noisy_run(), file_.path(), 50);
  const BranchHooks hooks{.go_on = [](double time) { return time < 1.0; }};
  EXPECT_THAT(test::refusal_of(branch_recording({.log = file_.path(), .at = 0.5, .duration = 100.0}, hooks)),
              HasSubstr("given up"));
}

}  // namespace
}  // namespace chicane::recording
