// SPDX-License-Identifier: MIT

#include "chicane/base/math.hpp"
#include "chicane/lap_time/detail/limit_model.hpp"
#include "chicane/lap_time/detail/plant_models.hpp"
#include "lap_time/derivatives.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"

namespace chicane::lap_time {
namespace {

road::Track circle() { return test::circle_road(60.0, 120, 5.0, 4.0); }

class PlantModel : public testing::TestWithParam<const char*> {
 protected:
  PlantModel() : model_{std::move(*make_limit_model(GetParam(), {}))} {
    road_ = lay_nodes(circle(), model_->guess_car(), 0.1);
    model_->set_road(road_);
  }
  /// A car in a bend, each variable a little different.
  std::vector<double> somewhere() const {
    const NodeFunctions& f = model_->functions();
    std::vector<double> z(static_cast<std::size_t>(f.variables), 0.0);
    model_->guess(15.0, 1.0, 0.02, z.data());
    for (std::size_t i = 0; i < z.size(); ++i) z[i] += (0.11 + 0.017 * static_cast<double>(i)) * f.scale[i];
    return z;
  }

  std::unique_ptr<LimitModel> model_;
  RoadNodes road_;
};

TEST_P(PlantModel, ItsDerivativesAreThoseOfDifferences) {
  expect_derivatives_of_differences(model_->functions(), 3, somewhere());
}

INSTANTIATE_TEST_SUITE_P(Plants, PlantModel, testing::Values("udacity", "road-car"), [](const auto& param) {
  return std::string(param.param) == "udacity" ? "Udacity" : "RoadCar";
});

TEST(UdacityModel, AcceleratesAndTurnsAsThePlantDoes) {
  const UdacityModel model;
  sim::UdacityCar car;
  car.reset({0.0, 0.0, -1.0}, 25.0);
  const model::Command command{0.08, 0.6};
  for (int i = 0; i < 1500; ++i) car.advance(command);
  const model::State& x = car.state();
  // The steady bend of the model and of the plant. What a State shows is from before the helper and after
  // drag.
  const double turn = 0.625 * model.car.steer_helper * sim::UdacityCar::kStepLength * x.r;
  const double vx = 1.001 * x.vx - turn * x.vy;
  const double vy = x.vy + turn * x.vx;
  const double pull = 0.6 * model.drive() - model.damping() * vx;
  const auto m = model.motion(vx, vy, x.r, 0.08, pull);
  EXPECT_NEAR(m.vx, 0.0, 0.05);
  EXPECT_NEAR(m.vy, 0.0, 0.15);  // of 14 m/s² that the tyres give
  EXPECT_NEAR(m.yaw, 0.0, 0.03);
}

TEST(DoubleTrackModel, HasTheForcesOfThePlantOnceItsTyresHaveSettled) {
  DoubleTrackModel model;
  sim::DoubleTrack car;
  car.reset({}, 25.0);
  const model::Command command{0.06, 0.3};
  double pedal = 0.0;
  Vec2 shift{};
  const double dt = sim::DoubleTrack::kStepLength;
  for (int i = 0; i < 2500; ++i) {
    car.advance(command);
    pedal = model.car.pedal().next(pedal, command.throttle, dt);
    shift += dt / model.car.load_lag * (Vec2{car.output().ax, car.output().ay} - shift);
  }
  const model::State& x = car.state();
  double z[DoubleTrackModel::kVariables] = {0.0, 0.0, x.vx, x.vy, x.r, x.steer, pedal, shift.x(), shift.y()};
  for (std::size_t i = 0; i < 4; ++i) z[DoubleTrackModel::kSlip + i] = car.output().slip_ratio[i];
  const auto m = model.motion(z);
  EXPECT_NEAR(m.ax, car.output().ax, 0.02);
  EXPECT_NEAR(m.ay, car.output().ay, 0.05);
  EXPECT_NEAR(m.yaw, 0.0, 0.02);
  for (const double balance : m.balance) EXPECT_NEAR(balance, 0.0, 0.01);
}

}  // namespace
}  // namespace chicane::lap_time
