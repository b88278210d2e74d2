// SPDX-License-Identifier: MIT
#include "chicane/live/limit_search.hpp"

#include <gtest/gtest.h>

#include <future>

#include "chicane/path/track.hpp"
#include "chicane/run/make.hpp"

namespace chicane::live {
namespace {

TEST(LimitVehicle, IsTheModelWithTheGripAndMassOfThePlant) {
  scenario::Scenario scenario;
  scenario.plant_options.friction_scale = 0.5;
  scenario.plant_options.mass_scale = 2.0;
  const model::VehicleParams car = limit_vehicle(scenario);
  EXPECT_EQ(car.friction, 0.5 * scenario.vehicle.friction);
  EXPECT_EQ(car.cornering_front, 0.5 * scenario.vehicle.cornering_front);
  EXPECT_EQ(car.mass, 2.0 * scenario.vehicle.mass);
  EXPECT_EQ(car.yaw_inertia, 2.0 * scenario.vehicle.yaw_inertia);
  EXPECT_EQ(car.drive_acceleration, 0.5 * scenario.vehicle.drive_acceleration) << "the same force";
  EXPECT_EQ(car.wheelbase(), scenario.vehicle.wheelbase());
}

using Answer = Result<std::shared_ptr<const lap_time::Limit>>;

TEST(LimitSearch, AnswersOnceAndHasEnded) {
  const scenario::Scenario scenario;
  const auto track = run::make_track(scenario);
  ASSERT_TRUE(track);
  std::promise<Answer> found;
  int answers = 0;
  LimitSearch search(*track, scenario, [&](Answer answer) {
    ++answers;
    found.set_value(std::move(answer));
  });
  const Answer answer = found.get_future().get();
  ASSERT_TRUE(answer) << answer.error().message;
  EXPECT_GT((*answer)->times.lap, 10.0);
  EXPECT_LT((*answer)->times.lap, 35.0) << "lakeside, which the default controller laps in 26 s";
  while (!search.has_ended()) std::this_thread::yield();
  search.cancel();
  EXPECT_EQ(answers, 1);
}

TEST(LimitSearch, SaysNothingOnceItIsCancelled) {
  const scenario::Scenario scenario;
  const auto track = run::make_track(scenario);
  ASSERT_TRUE(track);
  std::atomic<bool> is_cancelled{false};
  bool came_late = false;
  {
    LimitSearch search(*track, scenario, [&](const Answer&) { came_late = is_cancelled; });
    search.cancel();
    is_cancelled = true;
  }
  EXPECT_FALSE(came_late);
}

}  // namespace
}  // namespace chicane::live
