// SPDX-License-Identifier: MIT
#include "chicane/run/roads.hpp"

#include "chicane/base/random.hpp"
#include "chicane/run/make.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"
#include "support/runs.hpp"

namespace chicane::run {
namespace {

scenario::Scenario scenario_of(const std::string& track, const std::string& guard,
                               const std::string& car = "udacity") {
  return test::scenario_of(
      {{"track", track}, {"guard.mode", guard}, {"car", car}, {"laps", "0"}, {"time_limit_s", "4"}});
}

TEST(Roads, AreMadeOnceForEachTrackGuardAndCar) {
  Roads roads;
  const auto* first = roads.of(scenario_of("oval", "on")).value();
  EXPECT_EQ(roads.of(scenario_of("oval", "on")).value(), first);
  EXPECT_NE(roads.of(scenario_of("oval", "off")).value(), first);
  EXPECT_NE(roads.of(scenario_of("oval", "on", "road-car")).value(), first);
  EXPECT_EQ(roads.of(scenario_of("hairpins", "on")).value()->track.name(), "hairpins");
  scenario::Scenario lost = scenario_of("oval", "on");
  lost.track = "nowhere";
  EXPECT_FALSE(roads.of(lost));
}

TEST(Roads, ChangeNothingInARun) {
  Roads roads;
  for (const char* guard : {"on", "off"}) {
    const scenario::Scenario scenario = scenario_of("oval", guard);
    const std::uint64_t expected = test::drive(scenario).state_hash;
    for (int i = 0; i < 2; ++i) {
      const auto loop = ClosedLoop::create(scenario, roads);
      EXPECT_EQ(run_closed_loop(**loop).state_hash, expected) << guard;
    }
  }
}

TEST(Roads, RememberOnlyForWhichCarThereIsRoom) {
  Roads roads;
  for (int i = 0; i < 2; ++i) {
    EXPECT_TRUE(ClosedLoop::create(scenario_of("hairpins", "off", "udacity"), roads));
    EXPECT_FALSE(ClosedLoop::create(scenario_of("hairpins", "off", "indy"), roads));
  }
}

// The way along noisy points is longer than the road.
TEST(MakeWaypoints, ThinsDenseNoisyPointsEvenlyAllRound) {
  Random random{1};
  for (const double spacing : {0.25, 1.0, 4.0}) {
    const auto points = test::points_round(static_cast<int>(kTwoPi * 100.0 / spacing),
                                           [&](double) { return 100.0 + 0.1 * random.normal(); });
    const road::Track track = road::Track::create("dense", test::with_widths(points, 4.0, 4.0), true).value();
    const std::vector<road::TrackPoint> thinned = make_waypoints(track).value().raw_points();
    for (std::size_t i = 0; i < thinned.size(); ++i) {
      const double gap = (thinned[(i + 1) % thinned.size()].position - thinned[i].position).norm();
      EXPECT_TRUE(gap > 4.0 && gap < 19.0)
          << spacing << ", at " << i << " of " << thinned.size() << ": " << gap;
    }
  }
}

road::Track round_road() { return test::circle_road(60.0, 120, 4.0, 4.0, {}); }

/// Six waypoints on a circle of `radius`, `moved` metres to the east.
model::Measurement shown(double radius, double moved = 0.0) {
  model::Measurement measurement;
  measurement.waypoint_count = 6;
  for (int i = 0; i < 6; ++i)
    measurement.waypoints[static_cast<std::size_t>(i)] =
        Vec2{radius * std::cos(0.2 * i) + moved, radius * std::sin(0.2 * i)};
  return measurement;
}

TEST(TrackFit, SaysHowFarAnotherRoadIsAndNothingOfPlacesCloseToIt) {
  const road::Track track = round_road();
  for (const double radius : {60.0, 63.0, 60.0 + 4.0 + kBesideRoad - 0.5})
    EXPECT_FALSE(distance_to_other_road(track, shown(radius))) << radius;
  const auto distance = test::good(distance_to_other_road(track, shown(60.0, 63.0)));
  EXPECT_NEAR(*distance, 63.0, 0.5);  // the first waypoint is the farthest
  EXPECT_TRUE(distance_to_other_road(track, shown(60.0 - 4.0 - kBesideRoad - 0.5)));
}

TEST(TrackFit, OneWaypointAstrayOrTooFewSayNothing) {
  const road::Track track = round_road();
  model::Measurement measurement = shown(60.0);
  measurement.waypoints[2] = Vec2{500.0, 0.0};
  EXPECT_FALSE(distance_to_other_road(track, measurement));
  measurement = shown(500.0);
  measurement.waypoint_count = 1;
  EXPECT_FALSE(distance_to_other_road(track, measurement));
}

}  // namespace
}  // namespace chicane::run
