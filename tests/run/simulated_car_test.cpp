// SPDX-License-Identifier: MIT
#include "chicane/run/simulated_car.hpp"
#include "support/chicane_test.hpp"

namespace chicane::run {
namespace {

model::Command ahead() { return {.steer = 0.0, .throttle = 0.5}; }

TEST(SimulatedCar, LeavesTimeOutThatItCannotCatchUpWith) {
  const auto car = SimulatedCar::create(scenario::Scenario{}, 0.0).value();
  EXPECT_EQ(car->catch_up(0.2, ahead), 0.0);
  EXPECT_NEAR(car->world.time(), 0.2, 0.021);
  const double late = car->catch_up(2.0, ahead);
  EXPECT_NEAR(late, 2.0 - 0.2 - SimulatedCar::kCatchUp, 0.021);
  EXPECT_NEAR(car->world.time(), 2.0 - late, 0.021);
}

TEST(StopNews, SaysOnceThatTheCarIsStoppedThatItStandsAndThatItDrivesOn) {
  const auto car = SimulatedCar::create(scenario::Scenario{}, 0.0).value();
  std::vector<std::string> said;
  StopNews news(scenario::Scenario{}, [&](std::string_view line) { said.emplace_back(line); });
  const auto why = [] { return std::string("nobody is there"); };
  EXPECT_FALSE(news.look(*car, true, 0.0, why)) << "it stood already";
  EXPECT_FALSE(news.look(*car, false, 0.0, why));
  static_cast<void>(car->catch_up(0.3, ahead));
  EXPECT_TRUE(news.look(*car, true, 9.0, why));
  EXPECT_FALSE(news.look(*car, true, 9.0, why));
  car->plant->reset({}, 0.0);
  EXPECT_FALSE(news.look(*car, true, 0.2, why));
  EXPECT_FALSE(news.look(*car, true, 0.0, why));
  EXPECT_FALSE(news.look(*car, false, 0.0, why));
  EXPECT_THAT(
      said, ElementsAre("no command in time: the car is stopped from 9.0 m/s: nobody is there",
                        HasSubstr("m inside the road's edge: nobody is there"), HasSubstr("drives on from")));
}

}  // namespace
}  // namespace chicane::run
