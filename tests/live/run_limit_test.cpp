// SPDX-License-Identifier: MIT
#include "chicane/live/run_limit.hpp"

#include <mutex>
#include <thread>

#include "chicane/base/math.hpp"
#include "chicane/run/make.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"
#include "support/runs.hpp"

namespace chicane::live {
namespace {

scenario::Scenario on(const std::string& track) { return test::scenario_of({{"track", track}}); }

road::Track open_road() { return test::straight_road(30, 5.0, 5.0, {}); }

telemetry::RunSummary one_lap(double time) {
  telemetry::RunSummary run;
  run.laps.push_back({.lap_time = time, .sector_times = {time / 3.0, time / 3.0, time / 3.0}});
  return run;
}

const std::atomic<bool> kGoOn{false};
constexpr std::chrono::minutes kAsLongAsItTakes{10};  // on a machine that others keep busy

TEST(RunLimit, IsFoundBesideTheRunAndItsLapsAreSetBesideIt) {
  std::atomic<int> told{0};
  RunLimit limit([&](const lap_time::LimitAnswer& news) {
    EXPECT_NE(news.found, nullptr) << news.why_not;
    ++told;
  });
  const auto track = test::good(run::make_track(on("oval")));
  EXPECT_FALSE(RunLimit::first_answer(*track).why_not.empty());
  limit.search(*track, on("oval"));
  EXPECT_TRUE(limit.is_searching());
  telemetry::RunSummary run = one_lap(20.0);
  limit.compare(run, kGoOn, kAsLongAsItTakes);  // waits: there is a lap
  EXPECT_EQ(told, 1);
  ASSERT_TRUE(run.limit) << run.why_no_limit;
  EXPECT_NEAR(run.limit->lap, 12.93, 0.02);  // chicane limit --track oval
  EXPECT_EQ(run.why_no_limit, "");
  EXPECT_DOUBLE_EQ(run.laps[0].gap_to_limit.value_or(0.0), 20.0 / run.limit->lap - 1.0);
  EXPECT_DOUBLE_EQ(run.laps[0].sector_gaps[2], 20.0 / 3.0 / run.limit->sectors[2] - 1.0);
  const auto news = test::good(limit.news());
  EXPECT_EQ(news->found->times.lap, run.limit->lap);
  EXPECT_EQ(limit.news(), nullptr);  // once
}

TEST(RunLimit, SaysWhyThereIsNone) {
  telemetry::RunSummary run = one_lap(20.0);
  RunLimit limit;
  limit.search(open_road(), on("oval"));
  EXPECT_FALSE(limit.is_searching());
  limit.compare(run, kGoOn, kAsLongAsItTakes);
  EXPECT_FALSE(run.limit);
  EXPECT_EQ(run.why_no_limit, "the road is open: it has no laps");
  EXPECT_EQ(RunLimit::first_answer(open_road()).why_not, run.why_no_limit);

  limit.give_up("nobody knows the road");
  limit.compare(run, kGoOn, kAsLongAsItTakes);
  EXPECT_EQ(run.why_no_limit, "nobody knows the road");

  limit.search(test::circle_road(50.0, 60, 0.6, 0.6, {}), on("oval"));
  limit.compare(run, kGoOn, kAsLongAsItTakes);
  EXPECT_NE(run.why_no_limit.find("the road is"), std::string::npos) << run.why_no_limit;
}

TEST(RunLimit, DoesNotHoldUpARunThatEndsBeforeOrIsToStopOrHasWaitedLongEnough) {
  const auto track = run::make_track(on("lakeside"));
  struct End {
    bool has_lap, is_to_stop;
    std::chrono::milliseconds patience;
  };
  for (const End& end :
       {End{false, false, RunLimit::kPatience}, {true, true, RunLimit::kPatience}, {true, false, {}}}) {
    RunLimit limit;
    limit.search(*track, on("lakeside"));
    const std::atomic<bool> wants_stop{end.is_to_stop};
    telemetry::RunSummary run = end.has_lap ? one_lap(40.0) : telemetry::RunSummary{};
    limit.compare(run, wants_stop, end.patience);
    EXPECT_FALSE(run.limit);
    EXPECT_EQ(run.why_no_limit, "the run ended before it was computed");
  }
}

TEST(RunLimit, OfTheRunBeforeIsForgotten) {
  std::mutex mutex;
  std::vector<double> told;
  RunLimit limit([&](const lap_time::LimitAnswer& news) {
    const std::lock_guard lock(mutex);
    told.push_back(news.found ? news.found->times.lap : 0.0);
  });
  limit.search(*run::make_track(on("lakeside")), on("lakeside"));
  limit.search(*run::make_track(on("oval")), on("oval"));
  telemetry::RunSummary run = one_lap(20.0);
  limit.compare(run, kGoOn, kAsLongAsItTakes);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_NEAR(told[0], 12.93, 0.02);
}

/// What is told next; nothing when no search goes on.
std::shared_ptr<const lap_time::LimitAnswer> awaited_news(RunLimit& limit, const scenario::Scenario& now,
                                                          const telemetry::Frame& frame) {
  for (bool goes_on = true; goes_on; std::this_thread::sleep_for(std::chrono::milliseconds(10))) {
    limit.follow(now, frame);
    goes_on = limit.is_searching();  // asked first: news may come in between
    if (auto news = limit.news()) return news;
  }
  return std::make_shared<const lap_time::LimitAnswer>();
}

TEST(RunLimit, IsAnotherOneOnceTheCarHasOtherGripOrMass) {
  RunLimit limit;
  scenario::Scenario now = on("oval");
  limit.search(*run::make_track(now), now);
  telemetry::Frame frame;
  const auto first = awaited_news(limit, now, frame);
  ASSERT_TRUE(first->found);
  EXPECT_EQ(first->first_lap, 1);

  now.vehicle.friction *= 0.5;  // the controller's assumption: the car is as it was
  limit.follow(now, frame);
  EXPECT_FALSE(limit.is_searching());

  frame.lap = 3;  // in its fourth lap
  now.plant_options.friction_scale = 0.5;
  limit.follow(now, frame);
  const auto changed = test::good(limit.news());
  EXPECT_FALSE(changed->found);
  EXPECT_NE(changed->why_not.find("grip"), std::string::npos) << changed->why_not;
  const auto second = awaited_news(limit, now, frame);
  ASSERT_TRUE(second->found);
  EXPECT_EQ(second->first_lap, 5);
  // At half the grip a circle takes the square root of two as long; on the oval drive and top speed count,
  // too.
  EXPECT_GT(second->found->times.lap, 1.03 * first->found->times.lap);
  EXPECT_LT(second->found->times.lap, 1.5 * first->found->times.lap);

  telemetry::RunSummary run;
  for (int lap = 1; lap <= 5; ++lap) run.laps.push_back({.lap_time = 20.0});
  EXPECT_FALSE(limit.is_awaited(run));
  limit.compare(run, kGoOn, kAsLongAsItTakes);
  EXPECT_FALSE(run.laps[3].gap_to_limit);
  EXPECT_DOUBLE_EQ(run.laps[4].gap_to_limit.value_or(0.0), 20.0 / second->found->times.lap - 1.0);
}

TEST(RunLimit, HoldsForAllLapsOfACountThatBeginsAnew) {
  RunLimit limit;
  scenario::Scenario now = on("oval");
  limit.search(*run::make_track(now), now);
  telemetry::Frame frame;
  frame.lap = 7;
  now.plant_options.mass_scale = 1.5;
  limit.follow(now, frame);
  frame.lap = 0;
  frame.begins = true;
  telemetry::RunSummary run = one_lap(20.0);
  limit.follow(now, frame);
  EXPECT_TRUE(limit.is_awaited(run));
  limit.compare(run, kGoOn, kAsLongAsItTakes);
  EXPECT_TRUE(run.laps[0].gap_to_limit) << run.why_no_limit;
}

}  // namespace
}  // namespace chicane::live
