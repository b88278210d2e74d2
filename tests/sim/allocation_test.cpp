// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/sim/plant_registry.hpp"
#include "chicane/sim/sensor.hpp"
#include "chicane/sim/world.hpp"
#include "support/alloc_guard.hpp"

namespace chicane::sim {
namespace {

TEST(Simulation, AllocatesNothingOnceBuilt) {
  std::vector<road::TrackPoint> points;
  for (int i = 0; i < 100; ++i) {
    const double angle = kTwoPi * i / 100;
    points.push_back({Vec2{80.0 * std::cos(angle), 80.0 * std::sin(angle)}, 5.0, 5.0});
  }
  const road::Track track = road::Track::create("circle", points, true).value();
  for (const std::string_view name : plant_names()) {
    const auto plant = make_plant(name).value();
    World world{*plant, track};
    ActuationDelay delay;
    Sensor sensor{{.position_noise = 0.1}, 1};
    const test::AllocationGuard guard;
    for (int i = 0; i < 20000; ++i) {
      if (i % 10 == 0) {
        model::Measurement seen = sensor.sample(world.time(), *plant);
        select_waypoints(track, {seen.x, seen.y, seen.psi}, 6, seen);
        const double steer = 0.035 - 0.02 * world.state().lateral_error;
        delay.push(world.time() + 0.037, {.steer = steer, .throttle = 0.3});
      }
      world.advance(delay.at(world.time()));
    }
    EXPECT_EQ(guard.count(), 0) << name;
    EXPECT_GT(world.state().progress, 10.0) << name;
  }
}

}  // namespace
}  // namespace chicane::sim
