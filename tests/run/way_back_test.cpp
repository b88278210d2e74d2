// SPDX-License-Identifier: MIT
#include "chicane/run/way_back.hpp"

#include "chicane/run/parallel.hpp"
#include "support/chicane_test.hpp"
#include "support/runs.hpp"
#include "support/slow_tests.hpp"

namespace chicane::run {
namespace {

scenario::Scenario scenario_on(const std::string& track, const std::string& car) {
  return test::scenario_of({{"track", track}, {"car", car}});
}

/// Drives all starts with `jobs` threads.
std::vector<WayBackOutcome> drive_all_back(const scenario::Scenario& scenario,
                                           const std::vector<StartPose>& starts, int jobs) {
  std::vector<WayBackOutcome> outcomes(starts.size());
  for_each_run(starts.size(), jobs, [&](std::uint64_t i, Roads& roads) {
    outcomes[i] = drive_back(scenario, starts[i], roads).value();
    return true;
  });
  return outcomes;
}

TEST(WayBack, StartsAreAllKindsWithinReachOfTheRoadAndTheSameForTheSameSeed) {
  const road::Track track = make_track(scenario_on("oval", "udacity")).value();
  const auto starts = start_poses(track, 200, 3);
  ASSERT_EQ(starts.size(), 200U);
  std::array<int, kStartKindNames.size()> kinds{};
  double farthest = 0.0;
  for (const StartPose& start : starts) {
    ++kinds[static_cast<std::size_t>(start.kind)];
    const double edge = track.edge_distance(track.centre().project({start.state.x, start.state.y}));
    farthest = std::max(farthest, -edge);
    const double speed = std::hypot(start.state.vx, start.state.vy);
    EXPECT_LE(speed, 25.0);
    EXPECT_EQ(speed == 0.0, start.kind == StartKind::kStanding);
    EXPECT_EQ(start.state.vx < -1e-9, start.kind == StartKind::kBackwards || start.kind == StartKind::kSpun);
  }
  for (const int count : kinds) EXPECT_EQ(count, 40);
  EXPECT_LE(farthest, kFarthest + 1e-6);
  EXPECT_GT(farthest, 0.9 * kFarthest);
  EXPECT_EQ(start_poses(track, 7, 3)[6].state.x, starts[6].state.x);
  EXPECT_NE(start_poses(track, 7, 4)[6].state.x, starts[6].state.x);
}

TEST(WayBack, OutcomesDoNotDependOnTheNumberOfThreads) {
  const scenario::Scenario scenario = scenario_on("oval", "road-car");
  const auto starts = start_poses(make_track(scenario).value(), 3, 1);
  const auto one = drive_all_back(scenario, starts, 1);
  const auto two = drive_all_back(scenario, starts, 2);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    EXPECT_EQ(one[i].lapping, two[i].lapping) << i;
    EXPECT_EQ(one[i].least_edge, two[i].least_edge) << i;
  }
}

struct Named {
  const char* track;
  const char* car;
  std::size_t start;
};

/// Each left the car standing beside the road, or rolling away from it.
TEST(WayBack, IsFoundFromWhereItWasMissed) {
  for (const Named& each :
       {Named{"lakeside", "road-car", 4},      // turns round by leaving the road it stood on
        Named{"lakeside", "road-car", 103},    // stands at the edge, 35° away from the road
        Named{"oval", "udacity", 112},         // the same
        Named{"oval", "udacity", 35},          // rolls back fast: the brake is the reverse gear
        Named{"lakeside", "udacity", 120}}) {  // its place is where no car can have gone forward
    const scenario::Scenario scenario = scenario_on(each.track, each.car);
    const auto starts = start_poses(make_track(scenario).value(), 120, 1);
    Roads roads;
    const auto outcome = test::good(drive_back(scenario, starts[each.start - 1], roads));
    EXPECT_TRUE(outcome->has_come_back()) << each.track << " " << each.car << " " << each.start;
    EXPECT_LT(outcome->farthest, 95.0);  // measured: 91.3 m from the edge, of a car that rolls back fast
  }
}

TEST(WayBack, IsFoundFromAnywhere) {
  constexpr std::size_t kStarts = kDrivesAll ? 20 : 5;
  for (const char* track : {"lakeside", "oval"}) {
    for (const char* car : {"udacity", "road-car"}) {
      const scenario::Scenario scenario = scenario_on(track, car);
      const auto starts = start_poses(make_track(scenario).value(), kStarts, 2);  // each kind in turn
      const auto outcomes = drive_all_back(scenario, starts, 2);
      for (std::size_t i = 0; i < outcomes.size(); ++i)
        EXPECT_TRUE(outcomes[i].has_come_back())
            << "chicane recover --starts " << kStarts << " --seed 2 --tracks " << track << " --cars " << car
            << " --only " << i + 1;
    }
  }
}

/// The dashboard, the terminal and the recording show what the frame says.
TEST(WayBack, FrameSaysThatTheRoadIsTooFarAwayAndHowFar) {
  for (const char* preset : {"default", "weighted", "waypoints"}) {  // weighted answers from there
    const bool is_shown = std::string_view(preset) == "waypoints";
    auto scenario =
        test::scenario_of({{"track", "oval"}, {"preset", is_shown ? "default" : preset}, {"laps", "0"}});
    if (is_shown) scenario.guard.road = safety::GuardRoad::kWaypoints;
    const auto loop = test::loop_of(scenario);
    const road::PathPoint at = loop->track().centre().at(0.0);
    // Outside of the lap, whichever side that is.
    const double side =
        loop->track().centre().at(0.5 * loop->track().length()).position.y() > at.position.y() ? -1.0 : 1.0;
    loop->restart_at(
        {.x = at.position.x(), .y = at.position.y() + side * 300.0, .psi = at.heading, .vx = 8.0});
    while (loop->time() < 30.0) loop->advance();
    const telemetry::Frame& frame = loop->frame();
    EXPECT_LT(std::hypot(frame.truth.vx, frame.truth.vy), 0.1) << "it stands, its braking fades";
    EXPECT_EQ(frame.guard.reason, controller::GuardReason::kFarFromRoad) << preset;
    EXPECT_GT(std::fabs(frame.result.report.lateral_error), 250.0) << preset;
  }
}

}  // namespace
}  // namespace chicane::run
