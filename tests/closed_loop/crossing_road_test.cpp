// SPDX-License-Identifier: MIT
// Roads that cross themselves, and an open one.

#include "chicane/base/math.hpp"
#include "closed_loop/drive.hpp"
#include "support/folder.hpp"

namespace chicane::run {
namespace {

/// A figure of eight, 4.5 m to each side, whose points begin at `start` of the lap; 0 is the crossing. The
/// way over it is a mirror image for height < 0.
std::string eight(double length, double height, double start) {
  std::ostringstream out;
  out << "# x_m,y_m,w_tr_right_m,w_tr_left_m\n";
  constexpr int kPoints = 100;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = kTwoPi * (start + static_cast<double>(i) / kPoints);
    char row[96];
    std::snprintf(row, sizeof row, "%.3f,%.3f,4.5,4.5\n", length * std::sin(angle),
                  height * std::sin(2.0 * angle));
    out << row;
  }
  return out.str();
}

// Also where both passages have a waypoint in the same place, and where the run starts there. The cars take
// turns, as do the mirror images; with the slow tests each drives all of them.
TEST(CrossingRoad, IsDrivenFromTheTrackAndFromWaypoints) {
  const test::Folder folder;
  for (const double height : {120.0, -120.0}) {
    for (const double start : {0.0, 0.13}) {
      const std::string file = folder.write("eight.csv", eight(200.0, height, start));
      for (const std::string car : {"udacity", "road-car"}) {
        for (const char* road : {"track", "waypoints"}) {
          const bool is_mirrored = height < 0.0;
          const bool is_offset = start > 0.0;
          const bool is_turn =
              (car == "road-car") == is_offset && is_mirrored == (road[0] == 't') && is_mirrored == is_offset;
          if (!kDrivesAll && !is_turn) continue;
          drive_cleanly({{"car", car}, {"track", file}, {"guard.road", road}, {"laps", "2"}});
        }
      }
    }
  }
}

TEST(CrossingRoad, IsRaced) {
  if (kDrivesAll) {
    for (const char* car : {"udacity", "road-car"})
      drive_cleanly({{"preset", "race"}, {"car", car}, {"track", "crossover"}, {"laps", "2"}});
  }
  drive_cleanly({{"preset", "race"}, {"track", "crossover"}, {"guard.road", "waypoints"}, {"laps", "2"}});
}

TEST(OpenRoad, IsDrivenToItsFinishAndIsOneLap) {
  for (const char* car : {"udacity", "road-car"}) {
    const auto run = drive({{"preset", "default"}, {"car", car}, {"track", "stage"}, {"laps", "3"}});
    EXPECT_TRUE(run.completed) << car << ": " << run.end_reason;
    EXPECT_EQ(run.laps_completed, 1) << car;
    EXPECT_EQ(run.laps_wanted, 1) << car;
    EXPECT_EQ(run.off_track_events, 0) << car;
    EXPECT_EQ(run.fallbacks, 0U) << car << ": the road behind the finish is long enough to stop";
  }
}

// Without room behind its finish a race brakes before it, and passes it.
TEST(OpenRoad, IsFinishedAlsoWhereItEnds) {
  const test::Folder folder;
  std::ostringstream out;
  out << "# closed=false\n# x_m,y_m,w_tr_right_m,w_tr_left_m\n";
  for (int i = 0; i <= 40; ++i) out << 10.0 * i << ',' << 20.0 * std::sin(0.08 * i) << ",4.5,4.5\n";
  const std::string file = folder.write("open.csv", out.str());
  for (const char* car : {"udacity", "road-car"}) {
    drive_cleanly({{"preset", "race"}, {"car", car}, {"track", file}, {"laps", "1"}, {"time_limit_s", "60"}});
  }
}

TEST(OpenRoad, IsRacedAndEndsAtAStand) {
  for (const std::string car : {"udacity", "road-car"}) {
    if (!kDrivesAll && car != "udacity") break;
    const Settings slow{{"preset", "default"}, {"car", car}, {"track", "stage"}, {"laps", "1"}};
    const Settings on{
        {"preset", "race"}, {"car", car}, {"track", "stage"}, {"laps", "0"}, {"time_limit_s", "75"}};
    const auto loop = test::loop_of(test::scenario_of(on));
    const auto longer = run_closed_loop(*loop);
    ASSERT_EQ(longer.laps_completed, 1) << car;
    EXPECT_LT(longer.laps[0].lap_time, 0.96 * drive(slow).laps[0].lap_time) << car;
    EXPECT_EQ(longer.off_track_events, 0) << car;
    EXPECT_LT(loop->frame().measurement.speed, 1.0) << car;
    const double place = loop->track().start_s() + loop->world().progress;
    EXPECT_NEAR(place, loop->track().length() - 7.5, 7.5) << car << ": in the last metres of the road";
  }
}

}  // namespace
}  // namespace chicane::run
