// SPDX-License-Identifier: MIT
#include "chicane/telemetry/metrics.hpp"

#include "support/alloc_guard.hpp"
#include "support/chicane_test.hpp"

namespace chicane::telemetry {
namespace {

PhysicsSample sample(double speed, double error, double edge, bool off = false) {
  PhysicsSample s;
  s.step = 0.5;
  s.state.vx = speed;
  s.lateral_error = error;
  s.edge_distance = edge;
  s.is_off_track = off;
  return s;
}

std::unique_ptr<Frame> frame(double time, double steer) {
  auto f = std::make_unique<Frame>();
  f->time = time;
  f->has_truth = true;
  f->truth.steer = steer;
  f->result.report.solve.status = solver::SolveStatus::kOptimal;
  return f;
}

constexpr double kSumRounding = 1e-12;  // sums of a few exact numbers

TEST(Metrics, MeasuresALapFromEveryPhysicsStep) {
  Metrics metrics(3, 0.1);
  metrics.add_physics(sample(10.0, -3.0, 0.5));
  PhysicsSample second = sample(30.0, 1.0, 2.0);
  second.lateral_acceleration = -7.0;
  metrics.add_physics(second);
  metrics.lap_completed(0.93, {0.3, 0.3, 0.33});
  const RunSummary run = metrics.summary();
  ASSERT_EQ(run.laps.size(), 1u);
  EXPECT_EQ(run.laps_completed, 1);
  EXPECT_EQ(run.laps[0].lap_time, 0.93);
  EXPECT_EQ(run.laps[0].sector_times[2], 0.33);
  EXPECT_NEAR(run.laps[0].mean_speed, 20.0, kSumRounding);
  EXPECT_EQ(run.laps[0].top_speed, 30.0);
  EXPECT_NEAR(run.laps[0].rms_lateral_error, std::sqrt(5.0), kSumRounding);
  EXPECT_EQ(run.laps[0].max_abs_lateral_error, 3.0);
  EXPECT_EQ(run.laps[0].min_edge_distance, 0.5);
  EXPECT_EQ(run.laps[0].max_lateral_acceleration, 7.0);
  EXPECT_FALSE(run.laps[0].gap_to_limit.has_value());
}

TEST(Metrics, KeepsTheCornersOfEachLapThatWereTimed) {
  Metrics metrics(3, 0.1, 2);
  metrics.lap_completed(1.0, {0.3, 0.3, 0.4}, std::array{0.4, 0.6});
  metrics.lap_completed(1.1, {0.3, 0.3, 0.5}, std::array{0.5, 0.6});
  metrics.lap_completed(1.2);
  const RunSummary run = metrics.summary();
  ASSERT_EQ(run.laps.size(), 3u);
  EXPECT_EQ(run.laps[0].corner_times, (std::vector{0.4, 0.6}));
  EXPECT_EQ(run.laps[1].corner_times, (std::vector{0.5, 0.6}));
  ASSERT_EQ(run.laps[2].corner_times.size(), 2u);
  EXPECT_TRUE(std::isnan(run.laps[2].corner_times[0]));
}

TEST(Metrics, ANewLapStartsFromZeroAndTheTotalGoesOn) {
  Metrics metrics(3, 0.1);
  metrics.add_physics(sample(40.0, 4.0, -1.0));
  metrics.lap_completed(0.5);
  metrics.add_physics(sample(20.0, 1.0, 3.0));
  metrics.lap_completed(0.5);
  const RunSummary run = metrics.summary();
  ASSERT_EQ(run.laps.size(), 2u);
  EXPECT_EQ(run.laps[1].top_speed, 20.0);
  EXPECT_EQ(run.laps[1].min_edge_distance, 3.0);
  EXPECT_EQ(run.total.top_speed, 40.0);
  EXPECT_EQ(run.total.min_edge_distance, -1.0);
  EXPECT_NEAR(run.duration, 1.0, kSumRounding);
}

TEST(Metrics, CountsEachExcursionOnceAndItsWholeTime) {
  Metrics metrics(3, 0.1);
  for (const bool off : {false, true, true, false, true, false}) {
    metrics.add_physics(sample(1, 0, off ? -0.1 : 0.1, off));
  }
  metrics.add_physics(sample(1, 0, 0.01, true));  // back on the road, not yet judged so
  const RunSummary run = metrics.summary();
  EXPECT_EQ(run.off_track_events, 3);
  EXPECT_NEAR(run.out_of_track_time, 1.5, kSumRounding);
}

TEST(Metrics, IsCompletedOnTheRoadWithAllLapsAndAllTyresOnTheRoad) {
  RunSummary run;
  EXPECT_TRUE(completed_on_road(run));  // until stopped
  run.laps_wanted = 2;
  EXPECT_FALSE(completed_on_road(run));
  run.completed = true;
  EXPECT_TRUE(completed_on_road(run));
  run.off_track_events = 1;
  EXPECT_FALSE(completed_on_road(run));
}

TEST(Metrics, SteeringRateIsTakenFromCycleToCycle) {
  Metrics metrics(3, 0.1);
  metrics.add(*frame(0.0, 0.0));
  metrics.add(*frame(0.1, 0.02));
  metrics.add(*frame(0.2, 0.00));
  EXPECT_NEAR(metrics.summary().total.steering_rate_rms, 0.2, kSumRounding);
}

TEST(Metrics, CountsWhatWentWrongInTheSteps) {
  Metrics metrics(3, 0.1);
  auto f = frame(0.0, 0.0);
  f->result.report.solve.iterations = 4;
  metrics.add(*f);
  f->time = 0.1;
  f->result.report.solve.iterations = 2;
  f->result.report.solve.status = solver::SolveStatus::kStalled;
  f->guard.rung = controller::Rung::kShiftedPlan;
  f->guard.reason = controller::GuardReason::kFrozen;
  f->guard.gated = true;
  f->step_time = 0.2;
  f->solve_time = 0.15;
  metrics.add(*f);
  const RunSummary run = metrics.summary();
  EXPECT_EQ(run.cycles, 2u);
  EXPECT_EQ(run.mean_iterations, 3.0);
  EXPECT_EQ(run.not_usable, 1u);
  EXPECT_EQ(run.fallbacks, 1u);
  EXPECT_EQ(run.guard_reasons[static_cast<std::size_t>(controller::GuardReason::kFrozen)], 1u);
  EXPECT_EQ(run.guard_reasons[0], 1u);
  EXPECT_EQ(run.gate_interventions, 1u);
  EXPECT_EQ(run.deadline_misses, 1u);
  EXPECT_NEAR(run.step_time.max, 0.2, 1e-9);  // counted in whole nanoseconds
  EXPECT_NEAR(run.solve_time.max, 0.15, 1e-9);
}

TEST(Metrics, WithoutTruthItMeasuresWhatTheControllerWasTold) {
  Metrics metrics(3, 0.1);
  auto f = frame(0.0, 0.0);
  f->has_truth = false;
  f->measurement.speed = 12.0;
  f->lateral_error = -0.5;
  metrics.add(*f);
  f->time = 0.1;
  metrics.add(*f);
  f->time = 0.2;
  f->measurement.speed = std::nan("");
  metrics.add(*f);
  const RunSummary run = metrics.summary();
  EXPECT_NEAR(run.total.mean_speed, 12.0, kSumRounding);
  EXPECT_EQ(run.total.max_abs_lateral_error, 0.5);
  EXPECT_TRUE(std::isnan(run.total.min_edge_distance));
}

TEST(Metrics, TheHashSeesTheLastBitOfAStateAndOfACommand) {
  const auto hash = [](double x, double steer) {
    Metrics metrics(1, 0.1);
    PhysicsSample s = sample(1, 0, 0);
    s.state.x = x;
    metrics.add_physics(s);
    auto f = frame(0.0, 0.0);
    f->result.command.steer = steer;
    metrics.add(*f);
    return metrics.state_hash();
  };
  EXPECT_EQ(hash(1.0, 0.1), hash(1.0, 0.1));
  EXPECT_NE(hash(1.0, 0.1), hash(std::nextafter(1.0, 2.0), 0.1));
  EXPECT_NE(hash(1.0, 0.1), hash(1.0, std::nextafter(0.1, 1.0)));
}

TEST(Metrics, AllocatesNothingWhileRunningAndKeepsCountingBeyondItsCapacity) {
  Metrics metrics(2, 0.1);
  const auto f = frame(0.0, 0.0);
  const test::AllocationGuard guard;
  for (int lap = 0; lap < 5; ++lap) {
    metrics.add_physics(sample(1, 0, 0));
    metrics.add(*f);
    metrics.lap_completed(1.0);
  }
  EXPECT_EQ(guard.count(), 0);
  EXPECT_EQ(metrics.laps_completed(), 5);
  EXPECT_EQ(metrics.summary().laps.size(), 2u);
}

TEST(Metrics, ARunSetBesideTheLimitHasTheGapsOfItsLaps) {
  RunSummary run;
  run.laps.push_back({.lap_time = 30.0, .sector_times = {11.0, 9.0, kNotMeasured}});
  compare_with_limit(run, {.lap = 25.0, .sectors = {10.0, 9.0, 6.0}});
  ASSERT_TRUE(run.limit.has_value());
  ASSERT_TRUE(run.laps[0].gap_to_limit.has_value());
  EXPECT_NEAR(*run.laps[0].gap_to_limit, 0.2, 1e-12);
  EXPECT_NEAR(run.laps[0].sector_gaps[0], 0.1, 1e-12);
  EXPECT_EQ(run.laps[0].sector_gaps[1], 0.0);
  EXPECT_TRUE(std::isnan(run.laps[0].sector_gaps[2]));
}

using Texts = std::vector<std::string>;

Change at(double time, const char* name, const char* value) {
  return {.time = time, .name = std::string_view(name), .value = std::string_view(value)};
}

TEST(LapLedger, TellsTheSettingsAsTheyWereAtTheEndOfTheLap) {
  LapLedger ledger;
  EXPECT_EQ(ledger.setup(10.0, 10.0).names, Texts{});
  ledger.add(at(5.0, "latency_ms", "60"));
  ledger.add(at(12.0, "seed_of_doubt", "1"));
  ledger.add(at(25.0, "latency_ms", "80"));
  const LapSetup first = ledger.setup(10.0, 10.0);
  EXPECT_EQ(first.names, Texts{"latency_ms"});
  EXPECT_EQ(first.values, Texts{"60"});
  EXPECT_TRUE(first.is_mixed);
  const LapSetup second = ledger.setup(20.0, 5.0);
  EXPECT_EQ(second.names, (Texts{"latency_ms", "seed_of_doubt"}));
  EXPECT_EQ(second.values, (Texts{"60", "1"}));
  EXPECT_FALSE(second.is_mixed);
  EXPECT_TRUE(ledger.setup(30.0, 10.0).is_mixed);
  EXPECT_EQ(ledger.setup(30.0, 10.0).values.front(), "80");
}

TEST(LapLedger, ASettingThatIsSetToWhatItIsMixesNothing) {
  LapLedger ledger;
  ledger.add(at(1.0, "latency_ms", "60"));
  ledger.add(at(15.0, "latency_ms", "60"));
  EXPECT_FALSE(ledger.setup(20.0, 10.0).is_mixed);
}

TEST(LapLedger, CountsTheTimeByHand) {
  LapLedger ledger;
  EXPECT_EQ(ledger.setup(10.0, 10.0).by_hand_share, 0.0);
  ledger.add(at(15.0, "manual.is_on", "true"));
  ledger.add(at(15.1, "manual.steer", "0.5"));
  EXPECT_DOUBLE_EQ(ledger.setup(20.0, 10.0).by_hand_share, 0.5);
  EXPECT_DOUBLE_EQ(ledger.setup(30.0, 10.0).by_hand_share, 1.0);
  ledger.add(at(32.5, "manual.is_on", "false"));
  EXPECT_DOUBLE_EQ(ledger.setup(40.0, 10.0).by_hand_share, 0.25);
  EXPECT_DOUBLE_EQ(ledger.setup(50.0, 10.0).by_hand_share, 0.0);
  EXPECT_EQ(ledger.setup(50.0, 10.0).names, Texts{});
  EXPECT_FALSE(ledger.setup(40.0, 10.0).is_mixed);
}

TEST(LapLedger, NamesTheFaultsThatActedInTheLap) {
  LapLedger ledger;
  ledger.add(at(5.0, "fault.half_grip", "+8*0.3"));
  ledger.add(at(13.0, "fault.half_grip", "false"));
  ledger.add(at(14.0, "fault.link_lost", "true"));
  ledger.add(at(15.0, "run.pace", "4"));
  EXPECT_EQ(ledger.setup(10.0, 10.0).faults, Texts{"half_grip"});
  EXPECT_EQ(ledger.setup(20.0, 10.0).faults, (Texts{"half_grip", "link_lost"}));
  ledger.add(at(20.5, "fault.link_lost", "false"));
  EXPECT_EQ(ledger.setup(30.0, 5.0).faults, Texts{});
}

TEST(LapLedger, ARunThatStartsAgainKeepsSettingsAndHandsButNoFaults) {
  LapLedger ledger;
  ledger.add(at(5.0, "latency_ms", "60"));
  ledger.add(at(5.0, "manual.is_on", "true"));
  ledger.add(at(6.0, "fault.half_grip", "true"));
  ledger.restart();
  const LapSetup setup = ledger.setup(4.0, 4.0);
  EXPECT_EQ(setup.values, Texts{"60"});
  EXPECT_EQ(setup.faults, Texts{});
  EXPECT_FALSE(setup.is_mixed);
  EXPECT_EQ(setup.by_hand_share, 1.0);
}

TEST(LapLedger, AnotherRunBeginsWithNothing) {
  LapLedger ledger;
  ledger.add(at(5.0, "latency_ms", "60"));
  ledger.add({.name = std::string_view("track"), .value = std::string_view("oval"), .starts_anew = true});
  EXPECT_EQ(ledger.setup(4.0, 4.0).names, Texts{});
}

TEST(LapLedger, StaysBoundedAndKnowsTheNewestOfEverything) {
  LapLedger ledger;
  ledger.add(at(0.0, "seed_of_doubt", "7"));
  for (int i = 0; i < 5000; ++i) ledger.add(at(i, "latency_ms", std::to_string(i % 100).c_str()));
  const LapSetup setup = ledger.setup(4999.5, 10.0);
  EXPECT_EQ(setup.names, (Texts{"latency_ms", "seed_of_doubt"}));
  EXPECT_EQ(setup.values, (Texts{"99", "7"}));
  EXPECT_TRUE(setup.is_mixed);
}

/// Straight on along x at 10 m/s from (10 t, 0), points every 0.1 s.
controller::Plan plan_from(double time) {
  controller::Plan plan;
  plan.size = 5;
  for (int i = 0; i < plan.size; ++i) {
    controller::PlanPoint& point = plan.points[static_cast<std::size_t>(i)];
    point.time = time + 0.1 * i;
    point.x = 10.0 * point.time;
  }
  return plan;
}

TEST(PredictionCheck, IsTheDistanceFromWherePlansOfOneDelayAndPeriodAgoSaid) {
  PredictionCheck check;
  for (int cycle = 0; cycle < 20; ++cycle) {
    const double now = 0.05 * cycle;
    const double error = check.error(now, {10.0 * now + 0.3, 0.4});
    if (now < 0.1 + 0.05) {
      EXPECT_TRUE(std::isnan(error)) << now;
    } else {
      EXPECT_NEAR(error, 0.5, 1e-12) << now;  // a triangle of 3, 4, 5
    }
    check.add(plan_from(now + 0.1), 0.05);
  }
}

TEST(PredictionCheck, PredictsNothingAcrossACycleWithoutAPlan) {
  PredictionCheck check;
  for (int cycle = 0; cycle < 10; ++cycle) check.add(plan_from(0.1 + 0.05 * cycle), 0.05);
  check.add(controller::Plan{}, 0.05);
  EXPECT_TRUE(std::isnan(check.error(0.5, {5.0, 0.0})));
}

TEST(PredictionCheck, BeginsAnewWhenTimeRunsBackwards) {
  PredictionCheck check;
  for (int cycle = 0; cycle < 10; ++cycle) check.add(plan_from(100.0 + 0.05 * cycle), 0.05);
  for (int cycle = 0; cycle < 10; ++cycle) check.add(plan_from(0.1 + 0.05 * cycle), 0.05);
  EXPECT_NEAR(check.error(0.4, {4.0, 0.0}), 0.0, 1e-12);
}

TEST(PredictionCheck, ForgetsTheOldestWhenMoreIsPredictedThanItHolds) {
  PredictionCheck check;
  for (int cycle = 0; cycle < 1000; ++cycle) check.add(plan_from(0.01 * cycle), 0.01);
  EXPECT_TRUE(std::isnan(check.error(1.0, {10.0, 0.0})));
  EXPECT_NEAR(check.error(9.0, {90.0, 0.0}), 0.0, 1e-9);
}

TEST(ShortText, KeepsWhatFitsAndCutsTheRest) {
  EXPECT_EQ(ShortText<4>{}.view(), "");
  EXPECT_EQ(ShortText<4>{"abcd"}.view(), "abcd");
  EXPECT_EQ(ShortText<4>{std::string("abcdef")}.view(), "abcd");
  EXPECT_TRUE(ShortText<4>::fits("abcd"));
  EXPECT_FALSE(ShortText<4>::fits("abcde"));
}

TEST(Change, HasRoomForTheLongestKeyAndItsValue) {
  const std::string name(64, 'n');
  const std::string value(256, 'v');
  const Change change{.cycle = 3, .time = 0.12, .name = name, .value = value};
  const Change copy = change;
  EXPECT_EQ(copy.name.view(), name);
  EXPECT_EQ(copy.value.view(), value);
  EXPECT_FALSE(copy.starts_anew);
}

}  // namespace
}  // namespace chicane::telemetry
