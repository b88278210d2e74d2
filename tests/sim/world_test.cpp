// SPDX-License-Identifier: MIT
#include "chicane/sim/world.hpp"

#include "chicane/base/math.hpp"
#include "chicane/sim/plant_registry.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"

namespace chicane::sim {
namespace {

constexpr double kRadius = 60.0;

/// A car on strings: goes where it is put. Patches at (±1.5, ±1) m.
class Puppet final : public Plant {
 public:
  explicit Puppet(double step_length = 0.02) : step_length_{step_length} {}
  [[nodiscard]] double step_length() const noexcept override { return step_length_; }
  void reset(const model::Pose& pose, double speed) noexcept override {
    put(pose);
    output_.speed = speed;
  }
  void set_motion(const Vec2& velocity, double) noexcept override { output_.speed = velocity.norm(); }
  void deviate(const PlantDeviation& /*deviation*/) noexcept override {}
  void advance(const model::Command&) noexcept override {
    const Vec2 before{state_.x, state_.y};
    put(next_);
    output_.speed = (Vec2{state_.x, state_.y} - before).norm() / step_length_;
  }
  [[nodiscard]] const model::State& state() const noexcept override { return state_; }
  [[nodiscard]] const PlantOutput& output() const noexcept override { return output_; }
  [[nodiscard]] std::array<Vec2, 4> contact_points() const noexcept override {
    return {Vec2{1.5, 1.0}, Vec2{1.5, -1.0}, Vec2{-1.5, 1.0}, Vec2{-1.5, -1.0}};
  }
  void go(const model::Pose& pose) { next_ = pose; }

 private:
  void put(const model::Pose& pose) noexcept {
    state_.x = pose.x;
    state_.y = pose.y;
    state_.psi = pose.psi;
  }
  double step_length_;
  model::State state_;
  PlantOutput output_;
  model::Pose next_;
};

/// 5 m to the left edge and 4 m to the right.
road::Track circle(double kerb = 0.0) {
  return test::circle_road(kRadius, 120, 5.0, 4.0, {.smoothing_sigma = 0.0, .kerb_width = kerb});
}
road::Track straight() { return test::straight_road(30, 5.0, 4.0); }

/// On the circle at `angle` from the start, `left` of the line.
model::Pose on_circle(double angle, double left = 0.0) {
  const double r = kRadius - left;
  return {.x = r * std::cos(angle), .y = r * std::sin(angle), .psi = angle + kPi / 2.0};
}

/// A drive on the circle.
struct Drive {
  explicit Drive(double step_length = 0.02, double kerb = 0.0) : track{circle(kerb)}, puppet{step_length} {}
  void to(double angle, double left = 0.0) {
    puppet.go(on_circle(angle, left));
    world.advance({});
  }
  /// From angle to angle with constant speed in `steps` steps.
  void sweep(double from, double until, int steps, double left = 0.0) {
    for (int i = 1; i <= steps; ++i) to(from + (until - from) * i / steps, left);
  }
  const WorldState& state() const { return world.state(); }
  road::Track track;
  Puppet puppet;
  World world{puppet, track};
};

TEST(World, KnowsWhereTheCarIs) {
  Drive drive;
  drive.sweep(0.0, 1.0, 50, 1.5);
  // The spline through 120 points of a circle errs by 1e-5 of the radius at most; s by 1e-3 relative as Path
  // says.
  EXPECT_NEAR(drive.state().s, kRadius, 0.06);
  EXPECT_NEAR(drive.state().lateral_error, 1.5, 1e-3);
  EXPECT_NEAR(drive.state().heading_error, 0.0, 1e-3);
  EXPECT_NEAR(drive.state().progress, kRadius, 0.06);
  EXPECT_NEAR(drive.state().time, 1.0, 1e-12);
}

/// A plant with steps of 1 ms is judged every five of them.
TEST(World, TimesLapsAndTheirSectorsToAFractionOfAStep) {
  for (const double step : {0.02, 0.001}) {
    Drive drive{step};
    // 0.4 rad/s: a lap takes 2π / 0.4 = 15.70796 s, not a multiple of 0.02 s.
    for (int i = 1; i * step < 40.0 + 1e-9; ++i) drive.to(0.4 * step * i);
    const double lap_time = kTwoPi / 0.4;
    EXPECT_EQ(drive.state().lap, 2);
    EXPECT_NEAR(drive.state().last_lap_time, lap_time, 1e-5);  // rounding and the symmetry of the spline
    EXPECT_NEAR(drive.state().best_lap_time, lap_time, 1e-5);
    EXPECT_TRUE(drive.state().last_lap_was_clean);
    EXPECT_NEAR(drive.state().lap_time, 40.0 - 2.0 * lap_time, 1e-4);
    EXPECT_NEAR(drive.state().time, 40.0, 1e-9);
    double sum = 0.0;
    for (const double time : drive.state().last_sector_times) {
      EXPECT_NEAR(time, lap_time / 3.0, 1e-4);
      sum += time;
    }
    EXPECT_NEAR(sum, drive.state().last_lap_time, 1e-12);
  }
}

TEST(World, CountsALapOnceWhenTheLineIsCrossedBackAndForthAndNoneDrivenBackwards) {
  Drive drive;
  drive.sweep(0.0, kTwoPi + 0.02, 400);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(drive.state().lap, 1) << i;
    drive.sweep(kTwoPi + 0.02, kTwoPi - 0.05, 10);
    drive.sweep(kTwoPi - 0.05, kTwoPi + 0.02, 10);
  }
  drive.sweep(kTwoPi + 0.02, 2.0 * kTwoPi + 0.02, 400);
  EXPECT_EQ(drive.state().lap, 2);
  Drive backwards;
  backwards.sweep(0.0, -1.5 * kTwoPi, 600);
  EXPECT_EQ(backwards.state().lap, 0);
  EXPECT_LT(backwards.state().progress, -1.4 * kTwoPi * kRadius);
}

TEST(World, VoidsARoundThatCutsAcross) {
  Drive drive;
  drive.sweep(0.0, 1.0, 60);
  // Straight across the infield, from one side of the circle to the other.
  const model::Pose a = on_circle(1.0);
  const model::Pose b = on_circle(4.0);
  for (int i = 1; i <= 100; ++i) {
    drive.puppet.go({a.x + (b.x - a.x) * i / 100, a.y + (b.y - a.y) * i / 100, a.psi});
    drive.world.advance({});
  }
  drive.sweep(4.0, kTwoPi + 0.1, 100);
  EXPECT_EQ(drive.state().lap, 0);
  EXPECT_EQ(drive.state().void_laps, 1);
  EXPECT_GE(drive.state().off_track_events, 1);
  drive.sweep(0.1, kTwoPi + 0.1, 400);
  EXPECT_EQ(drive.state().lap, 1);
  EXPECT_TRUE(drive.state().last_lap_was_clean);
}

TEST(World, FirstDrivesToTheLineWhenItStartsElsewhere) {
  Drive drive;
  drive.world.reset(on_circle(1.0), 0.0);
  EXPECT_FALSE(drive.state().is_timed);
  drive.sweep(1.0, kTwoPi + 0.01, 300);
  EXPECT_TRUE(drive.state().is_timed);
  EXPECT_EQ(drive.state().lap, 0);
  drive.sweep(kTwoPi + 0.01, 2.0 * kTwoPi + 0.01, 400);
  EXPECT_EQ(drive.state().lap, 1);
}

TEST(World, MeasuresTheEdgeFromTheOutermostPatch) {
  Drive drive;
  drive.sweep(0.0, 0.5, 20);
  // The right rear and front patches lie 1 m right and 1.5 m along: √((60 + 1)² + 1.5²) − 60 = 1.01844 m off
  // the line.
  EXPECT_NEAR(drive.state().edge_distance, 4.0 - (std::hypot(61.0, 1.5) - 60.0), 1e-3);
  drive.sweep(0.5, 1.0, 20, 3.9);
  // Left patches 1 m left: 60 − √((60 − 4.9)² + 1.5²) from the line.
  EXPECT_NEAR(drive.state().edge_distance, 5.0 - (60.0 - std::hypot(55.1, 1.5)), 1e-3);
  EXPECT_FALSE(drive.state().is_off_track);
}

TEST(World, CountsAnOffTrackEventOnceUntilTheCarIsBackForAWhile) {
  Drive drive;
  drive.sweep(0.0, 0.2, 10, 0.0);
  drive.sweep(0.2, 0.4, 10, 4.2);  // left patches 0.2 m beyond the edge
  EXPECT_TRUE(drive.state().is_off_track);
  EXPECT_EQ(drive.state().off_track_events, 1);
  EXPECT_LT(drive.state().edge_distance, 0.0);
  drive.sweep(0.4, 0.45, 3, 3.0);  // back for 0.06 s only
  EXPECT_TRUE(drive.state().is_off_track);
  drive.sweep(0.45, 0.6, 5, 4.2);
  EXPECT_EQ(drive.state().off_track_events, 1);
  drive.sweep(0.6, 0.9, 15, 3.0);  // back for 0.3 s
  EXPECT_FALSE(drive.state().is_off_track);
  drive.sweep(0.9, 1.0, 5, -3.2);  // now beyond the right edge
  EXPECT_EQ(drive.state().off_track_events, 2);
  EXPECT_NEAR(drive.state().off_track_time, 0.02 * 20, 1e-9);
  EXPECT_NEAR(drive.state().min_edge_distance, 4.0 - (std::hypot(60.0 + 3.2 + 1.0, 1.5) - 60.0), 1e-3);
}

TEST(World, KerbIsDrivable) {
  Drive drive{0.02, 0.5};
  drive.sweep(0.0, 0.4, 20, 4.2);
  EXPECT_FALSE(drive.state().is_off_track);
  drive.sweep(0.4, 0.6, 10, 4.6);
  EXPECT_TRUE(drive.state().is_off_track);
}

// From the start line to the finish, whatever lies before and behind; also for a car that comes up to the
// start.
TEST(World, TimesAnOpenRoadFromStartToFinish) {
  const road::Track part =
      test::straight_road(30, 5.0, 4.0, {.smoothing_sigma = 0.0, .start_s = 40.0, .finish_s = 190.0});
  const road::Track whole = straight();
  struct Row {
    const road::Track& track;
    double from, lap, end;
  };
  for (const auto& [track, from, lap, end] :
       {Row{part, 10.0, 150.0, 190.0}, {part, 40.0, 150.0, 190.0}, {whole, 0.0, 300.0, 300.0}}) {
    Puppet puppet;
    World world{puppet, track};
    world.reset({.x = from, .y = 0.0, .psi = 0.0}, 0.0);
    int steps = 0;
    for (; !world.state().is_finished && steps < 2000; ++steps) {
      puppet.go({.x = from + 0.3 * (steps + 1), .y = 0.0, .psi = 0.0});
      world.advance({});
    }
    EXPECT_EQ(world.state().lap, 1) << from;
    EXPECT_NEAR(world.state().last_lap_time, lap / 15.0, 1e-6) << from;
    EXPECT_NEAR(steps * 0.3, end - from, 0.6) << from;
  }
}

TEST(World, RealCarsStandAtTheStart) {
  const road::Track track = circle();
  for (const std::string_view name : plant_names()) {
    const auto plant = make_plant(name).value();
    World world{*plant, track};
    for (int i = 0; i < 100; ++i) world.advance({});
    EXPECT_NEAR(plant->state().x, kRadius, 1e-6) << name;
    EXPECT_NEAR(world.state().progress, 0.0, 1e-3) << name;
    EXPECT_EQ(world.state().off_track_events, 0) << name;
  }
}

TEST(SelectWaypoints, ShowsOneBehindAndTheOthersAheadRoundTheEndOfAClosedTrack) {
  const road::Track track = circle();
  const double step = kTwoPi / 120.0;
  // Between two points the one behind is shown first, whichever of them is nearer.
  for (const double at : {10.3, 10.7, 118.4, 119.9}) {
    model::Measurement seen;
    EXPECT_EQ(select_waypoints(track, on_circle(at * step), 6, seen), 6);
    for (const int i : {0, 2, 5}) {
      const double angle = (std::floor(at) + i) * step;
      const Vec2& point = seen.waypoints[static_cast<std::size_t>(i)];
      EXPECT_NEAR(std::remainder(std::atan2(point.y(), point.x()) - angle, kTwoPi), 0.0, 1e-9)
          << at << ' ' << i;
    }
  }
}

road::Track eight() {
  return road::Track::create("eight", test::with_widths(test::eight_points(60, 60.0), 5.0, 5.0), true)
      .value();
}

// Also for a car beside the line and not quite along it, and where both passages have a waypoint.
TEST(SelectWaypoints, ShowsTheRoadThatIsDrivenWhereItCrossesItself) {
  const road::Track track = eight();
  for (const double side : {-4.0, 0.0, 4.0}) {
    for (const double turn : {-0.3, 0.0, 0.3}) {
      for (double s = 0.0; s < track.length(); s += 0.7) {
        const road::PathPoint at = track.centre().at(s);
        model::Measurement seen;
        select_waypoints(track,
                         {.x = at.position.x() - side * std::sin(at.heading),
                          .y = at.position.y() + side * std::cos(at.heading),
                          .psi = at.heading + turn},
                         6, seen);
        const double first = track.centre().project_along(seen.waypoints[1], at.heading, 5.0).s;
        const double ahead = track.centre().difference(first, s);
        EXPECT_TRUE(ahead > -12.0 && ahead < 18.0) << s << ' ' << side << ' ' << turn << ": " << ahead;
      }
    }
  }
}

TEST(World, TimesLapsOfAFigureOfEightFromAnyPlace) {
  const road::Track track = eight();
  for (const double start : {0.0, 0.25, 0.5, 0.52, 0.98}) {  // of the lap; it crosses itself at 0 and 0.5
    Puppet puppet{0.02};
    World world{puppet, track};
    const int lap_steps = 1000;
    for (int i = 0; i <= 2 * lap_steps + 20; ++i) {
      const road::PathPoint at =
          track.centre().at(track.length() * (start + static_cast<double>(i) / lap_steps));
      puppet.go({.x = at.position.x(), .y = at.position.y(), .psi = at.heading});
      if (i == 0) world.reset({.x = at.position.x(), .y = at.position.y(), .psi = at.heading}, 0.0);
      world.advance({});
    }
    EXPECT_EQ(world.state().off_track_events, 0) << start;
    EXPECT_GE(world.state().lap, 1) << start;
    EXPECT_NEAR(world.state().last_lap_time, lap_steps * 0.02, 0.05) << start;
    EXPECT_LT(std::fabs(world.state().lateral_error), 0.01) << start;
  }
}

TEST(SelectWaypoints, StopsAtTheEndOfAnOpenTrackAndKeepsItsBounds) {
  const road::Track track = straight();
  model::Measurement seen;
  EXPECT_EQ(select_waypoints(track, {.x = 285.0, .y = 0.0, .psi = 0.0}, 6, seen), 3);  // 280, 290, 300
  EXPECT_EQ(select_waypoints(track, {.x = 1000.0, .y = 0.0, .psi = 0.0}, 6, seen), 1);
  EXPECT_EQ(select_waypoints(track, {.x = -50.0, .y = 0.0, .psi = 0.0}, 6, seen), 6);
  EXPECT_EQ(seen.waypoints[0].x(), 0.0);
  EXPECT_EQ(select_waypoints(track, {}, 1000, seen), 31);
  EXPECT_EQ(select_waypoints(circle(), {}, 1000, seen), model::Measurement::kMaxWaypoints);
  EXPECT_EQ(select_waypoints(track, {}, -1, seen), 0);
}

/// Another place on the road is no way off it, and the clock goes on.
TEST(World, PutsTheCarElsewhereInTheSameRun) {
  Drive drive;
  World& world = drive.world;
  for (int i = 0; i < 50; ++i) drive.to(0.0);
  const double before = world.time();
  const model::Pose opposite{.x = -kRadius, .y = 0.0, .psi = -0.5 * kPi};
  world.put(opposite);
  drive.puppet.go(opposite);
  EXPECT_EQ(world.time(), before);
  for (int i = 0; i < 50; ++i) world.advance({});
  EXPECT_NEAR(world.time(), 2.0 * before, 1e-9);
  EXPECT_NEAR(world.state().s, 0.5 * drive.track.centre().length(), 0.1);
  EXPECT_GT(world.state().min_edge_distance, 2.0);
  EXPECT_EQ(world.state().lap, 0);
}

}  // namespace
}  // namespace chicane::sim
