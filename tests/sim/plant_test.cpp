// SPDX-License-Identifier: MIT
#include "chicane/sim/plant.hpp"

#include "chicane/base/random.hpp"
#include "chicane/base/text.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/sim/plant_registry.hpp"
#include "chicane/sim/udacity_car.hpp"
#include "support/chicane_test.hpp"

namespace chicane::sim {
namespace {

class EveryPlant : public ::testing::TestWithParam<std::string_view> {
 protected:
  std::unique_ptr<Plant> make(const PlantDeviation& deviation = {}) {
    return make_plant(GetParam(), deviation).value();
  }
  static int steps(const Plant& plant, double duration) {
    return static_cast<int>(duration / plant.step_length() + 0.5);
  }
};

INSTANTIATE_TEST_SUITE_P(Plants, EveryPlant, ::testing::ValuesIn(plant_names().begin(), plant_names().end()),
                         [](const auto& plant) {
                           std::string name(plant.param);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

bool is_finite(const Plant& plant) {
  const model::State& s = plant.state();
  const PlantOutput& o = plant.output();
  double sum = s.x + s.y + s.psi + s.vx + s.vy + s.r + s.steer + o.ax + o.ay + o.speed + o.throttle;
  for (std::size_t i = 0; i < 4; ++i) sum += o.slip_angle[i] + o.slip_ratio[i];
  return std::isfinite(sum);
}

TEST_P(EveryPlant, StandsStillWithoutCommands) {
  const auto plant = make();
  plant->reset({.x = 3.0, .y = -2.0, .psi = 1.0}, 0.0);
  for (int i = 0; i < steps(*plant, 10.0); ++i) plant->advance({});
  EXPECT_EQ(plant->state().x, 3.0);
  EXPECT_EQ(plant->state().y, -2.0);
  EXPECT_EQ(plant->output().speed, 0.0);
}

TEST_P(EveryPlant, DrivesOffAfterAStopAsItsModelSays) {
  const model::VehicleParams car =
      std::string_view{GetParam()} == UdacityCar::kName ? model::udacity_params() : model::road_car_params();
  const auto plant = make();
  const auto drive = [&](double throttle, double seconds) {
    for (int i = 0; i < steps(*plant, seconds); ++i) plant->advance({.steer = 0.0, .throttle = throttle});
  };
  plant->reset({}, 10.0);
  const double stopped = std::max(car.brake_latch_speed, 1.0);  // [m/s]
  for (int i = 0; i < steps(*plant, 10.0) && plant->output().speed > stopped; ++i)
    plant->advance({.steer = 0.0, .throttle = -car.brake_throttle_limit});
  drive(1.0, 3.0);
  EXPECT_EQ(plant->output().speed < 0.1, car.latches_brakes());  // [m/s]; a free car is at 15 m/s by then
  drive(car.brake_release_throttle, 0.02);                       // the shortest control period of a preset
  drive(1.0, 3.0);
  EXPECT_GT(plant->output().speed, 5.0);
}

TEST_P(EveryPlant, MirrorsWhenTheSteeringFlips) {
  const auto left = make();
  const auto right = make();
  left->reset({}, 15.0);
  right->reset({}, 15.0);
  Random random{9};
  for (int k = 0; k < 40; ++k) {
    const double steer = random.uniform(-0.3, 0.3);
    const double throttle = random.uniform(-1.0, 1.0);
    for (int i = 0; i < steps(*left, 0.2); ++i) {
      left->advance({.steer = steer, .throttle = throttle});
      right->advance({.steer = -steer, .throttle = throttle});
    }
  }
  // The wheels are summed in another order: rounding only, over 8 s without chaos.
  EXPECT_NEAR(left->state().y, -right->state().y, 1e-8);
  EXPECT_NEAR(left->state().psi, -right->state().psi, 1e-9);
  EXPECT_NEAR(left->state().vx, right->state().vx, 1e-9);
}

TEST_P(EveryPlant, DoesNotKnowWhereNorthIs) {
  const auto here = make();
  const auto there = make();
  here->reset({}, 20.0);
  there->reset({.x = 100.0, .y = 50.0, .psi = 0.3}, 20.0);
  for (int i = 0; i < steps(*here, 4.0); ++i) {
    const model::Command command{.steer = 0.05 * std::sin(i * here->step_length()), .throttle = 0.3};
    here->advance(command);
    there->advance(command);
  }
  const double c = std::cos(0.3);
  const double s = std::sin(0.3);
  EXPECT_NEAR(there->state().x, 100.0 + c * here->state().x - s * here->state().y, 1e-9);
  EXPECT_NEAR(there->state().y, 50.0 + s * here->state().x + c * here->state().y, 1e-9);
  EXPECT_NEAR(there->state().psi, 0.3 + here->state().psi, 1e-10);
}

TEST_P(EveryPlant, StaysFiniteWhateverItIsTold) {
  const auto plant = make();
  Random random{21};
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::array<double, 6> nasty{inf, -inf, nan, 1e300, -1e300, -0.0};
  for (int run = 0; run < 20; ++run) {
    plant->reset({}, random.uniform(0.0, 60.0));
    for (int k = 0; k < 50; ++k) {
      model::Command command{.steer = random.uniform(-1.0, 1.0), .throttle = random.uniform(-2.0, 2.0)};
      if (k % 10 == 3) command.steer = nasty[random.bits() % nasty.size()];
      if (k % 10 == 7) command.throttle = nasty[random.bits() % nasty.size()];
      for (int i = 0; i < steps(*plant, 0.1); ++i) plant->advance(command);
      ASSERT_TRUE(is_finite(*plant)) << "run " << run << " at " << k;
      ASSERT_LT(plant->output().speed, 100.0);
    }
  }
}

TEST_P(EveryPlant, NeverGainsEnergyWithoutDrive) {
  const auto plant = make();
  Random random{4};
  plant->reset({}, 40.0);
  double before = 40.0;
  for (int k = 0; k < 60; ++k) {
    const double steer = random.uniform(-0.4, 0.4);
    for (int i = 0; i < steps(*plant, 0.1); ++i) plant->advance({.steer = steer, .throttle = 0.0});
    // Spinning motion and wheels give a little back: both together hold less than 2 % of 40 m/s.
    EXPECT_LT(plant->output().speed, before + 0.2);
    before = plant->output().speed;
  }
  EXPECT_LT(before, 35.0);
}

TEST_P(EveryPlant, SaysHowMuchOfItsGripEachAxleUses) {
  const auto plant = make();
  const auto drive = [&](double speed, double steer, double throttle) {
    plant->reset({}, speed);
    for (int i = 0; i < steps(*plant, 1.0); ++i) plant->advance({.steer = steer, .throttle = throttle});
    return plant->output().tire_use;
  };
  const auto rolling = drive(20.0, 0.0, 0.0);
  EXPECT_LT(rolling[0] + rolling[1], 0.1);
  const auto gentle = drive(15.0, 0.03, 0.0);
  const auto hard = drive(25.0, 0.4, 0.0);
  EXPECT_GT(gentle[0], rolling[0]);
  EXPECT_LT(gentle[0], 0.7);
  EXPECT_GT(hard[0], 1.0) << "full lock at 25 m/s slides";
  // On half the grip the same corner takes more of it.
  const auto slippery = make({.friction_scale = 0.5});
  slippery->reset({}, 15.0);
  for (int i = 0; i < steps(*slippery, 1.0); ++i) slippery->advance({.steer = 0.03, .throttle = 0.0});
  EXPECT_GT(slippery->output().tire_use[0], 1.2 * gentle[0]);
}

TEST_P(EveryPlant, ResetForgetsEverything) {
  const auto used = make();
  const auto fresh = make();
  for (int i = 0; i < 1000; ++i) used->advance({.steer = 0.1, .throttle = 1.0});
  used->reset({}, 5.0);
  fresh->reset({}, 5.0);
  const PlantOutput &seen = used->output(), &expected = fresh->output();
  EXPECT_EQ(std::tie(seen.speed, seen.ax, seen.ay, seen.throttle),
            std::tie(expected.speed, expected.ax, expected.ay, expected.throttle));
  EXPECT_EQ(std::tie(seen.slip_angle, seen.slip_ratio, seen.tire_use),
            std::tie(expected.slip_angle, expected.slip_ratio, expected.tire_use));
  for (int i = 0; i < 1000; ++i) {
    used->advance({.steer = 0.02, .throttle = 0.3});
    fresh->advance({.steer = 0.02, .throttle = 0.3});
  }
  EXPECT_EQ(used->state().x, fresh->state().x);
  EXPECT_EQ(used->state().r, fresh->state().r);
}

TEST_P(EveryPlant, LessFrictionBrakesLaterMoreMassAcceleratesSlower) {
  const auto nominal = make();
  const auto slippery = make({.friction_scale = 0.5});
  const auto heavy = make({.mass_scale = 1.5});
  for (Plant* plant : {nominal.get(), slippery.get(), heavy.get()}) {
    plant->reset({}, 30.0);
    for (int i = 0; i < steps(*plant, 1.5); ++i) plant->advance({.steer = 0.0, .throttle = -1.0});
  }
  EXPECT_GT(slippery->output().speed, nominal->output().speed + 3.0);
  for (Plant* plant : {nominal.get(), heavy.get()}) {
    plant->reset({}, 0.0);
    for (int i = 0; i < steps(*plant, 4.0); ++i) plant->advance({.steer = 0.0, .throttle = 0.8});
  }
  EXPECT_LT(heavy->output().speed, 0.8 * nominal->output().speed);
}

TEST(MakePlant, RefusesUnknownNamesAndDeviationsOutOfRange) {
  EXPECT_EQ(make_plant("boat").error().message, "plant: got boat, expected one of " + joined(plant_names()));
  EXPECT_EQ(make_plant("boat").error().code, ErrorCode::kNotFound);
  EXPECT_THAT(make_plant("udacity", {.friction_scale = 0.0}).error().message, HasSubstr("friction_scale"));
  EXPECT_THAT(make_plant("road-car", {.mass_scale = 5.0}).error().message, HasSubstr("mass_scale"));
}

}  // namespace
}  // namespace chicane::sim
