// SPDX-License-Identifier: MIT
#include "chicane/recording/shadow_run.hpp"

#include "support/chicane_test.hpp"
#include "support/own_controller.hpp"
#include "support/runs.hpp"

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

}  // namespace
}  // namespace chicane::recording
