// SPDX-License-Identifier: MIT
#include "chicane/recording/checkpoints.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "chicane/protocol/library.hpp"
#include "chicane/recording/branch.hpp"
#include "chicane/recording/rebuilt_run.hpp"

namespace chicane::recording {
namespace {

scenario::Scenario oval() {
  const auto scenario = protocol::compose(
      {.scenario_file = {},
       .settings = {{"track", "oval"}, {"laps", "0"}, {"sensor.position_noise_m", "0.02"}}});
  EXPECT_TRUE(scenario);
  return scenario.value_or(scenario::Scenario{});
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

TEST(Checkpoints, LeadToTheSameFuturesAsTheStartOfTheRun) {
  const auto events = drive(60.0);
  Checkpoints checkpoints;
  for (const RecordedEvent& event : events) ASSERT_TRUE(checkpoints.follow(event));
  for (const double at : {0.0, 4.0, 7.98, 13.0, 25.0, 40.0, 59.0, 1e9}) {
    SCOPED_TRACE(at);
    BranchOptions options{
        .at = at, .settings = {{"tracking_mpc.speed_limit_mps", "12"}}, .duration = 4.0, .drives_both = true};
    const auto from_start = numbers(events, 0, options);
    options.from = newest_before(checkpoints.kept(), at);
    EXPECT_EQ(options.from == nullptr, at == 0.0);
    if (!options.from) continue;
    std::uint64_t steps_before = 0;
    // The scenario, which no checkpoint counts, comes first.
    EXPECT_EQ(numbers(events, options.from->event_count + 1, options, &steps_before), from_start);
    EXPECT_LE(static_cast<double>(steps_before) * 0.04, std::max(60.0 - at, Checkpoints::kSpacing));
  }
}

TEST(RebuiltRun, ComesOutTheSameToTheLastBitAndTellsItsLaps) {
  int laps = 0;
  RebuiltRun run([&](const telemetry::CompletedLap&) { ++laps; });
  EXPECT_FALSE(run.has_begun());
  for (const RecordedEvent& event : drive(40.0)) {
    if (const auto* scenario = std::get_if<scenario::Scenario>(&event)) {
      ASSERT_TRUE(run.begin(*scenario, run::make_controller));
    } else if (const auto* change = std::get_if<telemetry::Change>(&event)) {
      run.apply(*run::read_setting(*change));
    } else {
      protocol::Step step = std::get<RecordedStep>(event).step;
      const telemetry::Frame& frame = run.follow(step);
      ASSERT_TRUE(is_same(frame, step)) << step.cycle;
      step.measurement.x = std::nextafter(step.measurement.x, 1e9);
      ASSERT_FALSE(is_same(frame, step)) << "a bit is a difference";
    }
  }
  EXPECT_EQ(laps, run.loop().world().lap);
  EXPECT_GE(laps, 1);
  run.forget();
  EXPECT_FALSE(run.has_begun());
}

TEST(Checkpoints, AreFewAndNeverFartherThanAMomentIsAgo) {
  Checkpoints checkpoints;
  double last = 0.0;
  for (const RecordedEvent& event : drive(600.0)) {
    ASSERT_TRUE(checkpoints.follow(event));
    const auto* step = std::get_if<RecordedStep>(&event);
    if (step == nullptr || step->log_time < last + 1.0) continue;
    last = step->log_time;
    double after = last;
    for (auto each = checkpoints.kept().rbegin(); each != checkpoints.kept().rend(); ++each) {
      const double gap = after - (*each)->time;
      EXPECT_LE(gap, std::max(last - after, Checkpoints::kSpacing) + 0.1) << last;
      after = (*each)->time;
    }
    EXPECT_LE(checkpoints.kept().size(), 12U) << last;
  }
  EXPECT_GE(checkpoints.kept().size(), 5U);
}

TEST(Checkpoints, AreOfTheNewestRunAndOfWhatIsKnownOnly) {
  const auto events = drive(20.0);
  Checkpoints checkpoints;
  for (const RecordedEvent& event : events) ASSERT_TRUE(checkpoints.follow(event));
  const auto newest = newest_before(checkpoints.kept(), 1e9);
  ASSERT_NE(newest, nullptr);
  EXPECT_EQ(newest_before(checkpoints.kept(), 1e9, newest->event_count + 1), nullptr) << "forgotten by now";
  EXPECT_LT(newest_before(checkpoints.kept(), newest->time)->time, newest->time);
  ASSERT_TRUE(checkpoints.follow(events.front()));
  EXPECT_TRUE(checkpoints.kept().empty());
}

}  // namespace
}  // namespace chicane::recording
