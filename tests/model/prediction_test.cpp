// SPDX-License-Identifier: MIT
#include "chicane/model/prediction.hpp"

#include "chicane/base/random.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/model/wheel_forces.hpp"
#include "support/chicane_test.hpp"

namespace chicane::model {
namespace {

VehicleParams car_number(int i) { return i == 0 ? udacity_params() : road_car_params(); }

BodyMotion<double> settle(const PredictionModel& model, double speed, double steer, double seconds,
                          double dt) {
  BodyMotion<double> motion{.vx = speed};
  for (double t = 0.0; t < seconds; t += dt) {
    motion = model.advance(motion, steer, 0.0, dt, model.lags(dt));
    motion.vx = speed;
  }
  return motion;
}

TEST(PredictionModel, TurnsAsTheWheelbaseSaysWhenSlow) {
  for (int i = 0; i < 2; ++i) {
    const VehicleParams car = car_number(i);
    const BodyMotion<double> motion = settle(PredictionModel(car), 3.0, 0.1, 5.0, 0.02);
    // Tyres slip a little even at walking pace; the speed floor of the slip angles adds its share.
    EXPECT_NEAR(motion.r, 3.0 * std::tan(0.1) / car.wheelbase(), 0.06 * motion.r) << car.name;
  }
}

TEST(PredictionModel, HasTheYawGainOfTheOriginalCar) {
  // udacity/self-driving-car-sim v1.45, fitted to published logs: ψ'/δ = 7.1, 10.9 and 17 1/s at 20, 30 and
  // 45 m/s.
  const PredictionModel model(udacity_params());
  EXPECT_NEAR(settle(model, 20.0, 0.01, 10.0, 0.01).r / 0.01, 7.1, 0.4);
  EXPECT_NEAR(settle(model, 30.0, 0.01, 10.0, 0.01).r / 0.01, 10.9, 0.6);
  EXPECT_NEAR(settle(model, 45.0, 0.01, 15.0, 0.01).r / 0.01, 17.0, 1.2);
}

TEST(PredictionModel, StaysFiniteFromStandstillToTopSpeedForAnyStep) {
  Random random(11);
  for (int i = 0; i < 2000; ++i) {
    const PredictionModel model(car_number(i % 2));
    BodyMotion<double> motion{
        .vx = random.uniform(0.0, 60.0), .vy = random.uniform(-2.0, 2.0), .r = random.uniform(-1.5, 1.5)};
    for (int k = 0; k < 20; ++k) {
      const double steer = random.uniform(-0.43, 0.43);
      const double acceleration = random.uniform(-9.0, 5.0);
      const double dt = random.uniform(0.001, 0.1);
      motion = model.advance(motion, steer, acceleration, dt, model.lags(dt));
      motion.vx = std::max(motion.vx, 0.0);
    }
    EXPECT_TRUE(std::isfinite(motion.vx + motion.vy + motion.r));
    EXPECT_LT(std::fabs(motion.r), 20.0);
  }
}

TEST(PredictionModel, KnowsThatHardBrakingMakesAFastCarUnstable) {
  const PredictionModel model(road_car_params());
  const auto yaw_rate_after_a_second = [&](double acceleration) {
    BodyMotion<double> motion{.vx = 50.0, .r = 0.01, .acceleration = acceleration};
    for (int k = 0; k < 100; ++k) {
      motion = model.advance(motion, 0.0, acceleration, 0.01, model.lags(0.01));
      motion.vx = 50.0;
    }
    return std::fabs(motion.r);
  };
  EXPECT_LT(yaw_rate_after_a_second(0.0), 0.002);
  EXPECT_GT(yaw_rate_after_a_second(-8.0), 0.01) << "the rear axle carries too little to lead";
}

TEST(PredictionModel, MirrorsLeftAndRightExactly) {
  const PredictionModel model(road_car_params());
  const BodyMotion<double> left =
      model.advance({25.0, -0.4, 0.3, 0.05, -2.0}, 0.08, -3.0, 0.05, model.lags(0.05));
  const BodyMotion<double> right =
      model.advance({25.0, 0.4, -0.3, -0.05, -2.0}, -0.08, -3.0, 0.05, model.lags(0.05));
  EXPECT_EQ(left.vx, right.vx);
  EXPECT_EQ(left.vy, -right.vy);
  EXPECT_EQ(left.r, -right.r);
  EXPECT_EQ(left.steer, -right.steer);
}

TEST(PredictionModel, SteersForTheYawAccelerationAskedFor) {
  for (const VehicleParams& car : {udacity_params(), road_car_params()}) {
    const PredictionModel model(car);
    for (const double wanted : {-1.0, -0.2, 0.0, 0.5, 1.0}) {
      BodyMotion<double> m{.vx = 20.0, .vy = -0.1, .r = 0.1, .steer = 0.0, .acceleration = -2.0};
      for (int i = 0; i < 20; ++i)
        m.steer = model.steer_for(m, wanted);  // its stiffness is that of the wheel now
      constexpr double kShort = 1e-5;
      const BodyMotion<double> to = model.advance(m, m.steer, m.acceleration, kShort);
      EXPECT_NEAR((to.r - m.r) / kShort, wanted, 0.05) << car.name;
      // Its mirror image asks for the mirrored wheel.
      EXPECT_NEAR(model.steer_for({20.0, 0.1, -0.1, -m.steer, -2.0}, -wanted), -model.steer_for(m, wanted),
                  1e-12);
    }
  }
}

/// Lateral force of the front axle over its load, straight ahead with the wheel turned by `slip`.
double front_force(const PredictionModel& model, double slip, double acceleration) {
  constexpr double kShort = 1e-6;
  const VehicleParams& car = model.vehicle();
  const BodyMotion<double> from{.vx = 40.0, .acceleration = acceleration};
  const double yaw = model.advance(from, slip, acceleration, kShort).r / kShort;
  const double load = car.rear_axle / car.wheelbase() * model.load(40.0) -
                      car.height / 9.81 * 9.81 / car.wheelbase() * acceleration;
  const double share = acceleration < 0.0 ? car.brake_share_front : car.drive_share_front;
  return (yaw * car.yaw_inertia / (car.mass * car.front_axle) - share * acceleration * slip) / load;
}

TEST(PredictionModel, HasTheTyreCurvesOfThePlants) {
  // The original simulator's: from (0, 0) to its peak at a slip of friction over stiffness, then three
  // quarters of it (sim/udacity_car.hpp); its secant rises first.
  const VehicleParams udacity = udacity_params();
  const FrictionCurve curve{.extremum_slip = udacity.friction / udacity.cornering_front,
                            .extremum_value = udacity.friction,
                            .asymptote_slip = 2.5 * udacity.friction / udacity.cornering_front,
                            .asymptote_value = 0.75 * udacity.friction};
  for (const double slip : {0.01, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7})
    EXPECT_NEAR(front_force(PredictionModel(udacity), slip, 0.0), curve(slip), 2e-3) << slip;
  // A magic formula without curvature.
  VehicleParams road = road_car_params();
  road.height = 0.0;  // load moved to the outer wheel costs grip
  road.drag_quadratic = 0.0;
  const MagicFormula formula{.stiffness = road.cornering_front / (road.tire_shape * road.friction),
                             .shape = road.tire_shape,
                             .peak = road.friction};
  for (const double slip : {0.01, 0.05, 0.1, 0.2, 0.4})
    EXPECT_NEAR(front_force(PredictionModel(road), slip, 0.0), formula(slip), 2e-3) << slip;
}

TEST(PredictionModel, SharesForceBetweenTheDirectionsWhereTyresDo) {
  const VehicleParams road = road_car_params();
  const PredictionModel model(road);
  EXPECT_LT(front_force(model, 0.05, -8.0), 0.9 * front_force(model, 0.05, 0.0));
  const auto use = model.tire_use(BodyMotion<double>{.vx = 40.0, .acceleration = -8.0});
  EXPECT_GT(use.front, 0.1) << "it slips along";
  EXPECT_GT(use.along_front, use.along_rear) << "brakes are biased to the front";
  VehicleParams uncoupled = road;
  uncoupled.friction_coupling = 0.0;
  EXPECT_EQ(PredictionModel(uncoupled).tire_use(BodyMotion<double>{.vx = 40.0, .acceleration = -8.0}).front,
            0.0);
}

// Too little slip along lets a rear-driven car press its throttle in a bend until it spins.
TEST(PredictionModel, LosesTheForceAcrossThatDriveTakes) {
  VehicleParams car = road_car_params();
  car.drive_share_front = 0.0;
  car.height = 0.0;  // no load is moved
  const PredictionModel model(car);
  constexpr double kSpeed = 30.0;
  const double rear = car.front_axle / car.wheelbase();
  const double grip = car.friction * rear * car.load(kSpeed);
  const auto secant = [&](double square) { return magic_secant(car.tire_shape, square + 1e-12); };
  for (const double share : {0.6, 0.95}) {
    const double z = share * car.tire_shape * std::tan(0.5 * kPi / car.tire_shape);
    const double slip = z * car.friction / car.cornering_rear;
    for (const double along : {0.2, 0.4, 0.6}) {
      double z_along = along;  // equation 4b, until it holds
      for (int i = 0; i < 200; ++i) z_along = along / secant(z * z + z_along * z_along);
      const auto change =
          model.change(BodyMotion<double>{.vx = kSpeed, .vy = -slip * kSpeed, .acceleration = along * grip});
      const double moment = change.r * car.yaw_inertia / car.mass;
      const double force = (car.front_axle * change.vy - moment) / car.wheelbase();
      const double expected = grip * z * secant(z * z + z_along * z_along);
      EXPECT_NEAR(force, expected, 0.035 * expected) << share << ' ' << along;
    }
  }
}

TEST(PredictionModel, ItsChangeByTimeIsTheLimitOfItsSteps) {
  for (int i = 0; i < 2; ++i) {
    const PredictionModel model(car_number(i));
    for (const double net : {-8.0, -2.0, 2.0, 4.5}) {
      for (const double side : {1.0, -1.0}) {
        const BodyMotion<double> from{24.0, -0.8 * side, 0.35 * side, 0.07 * side, net};
        constexpr double kShort = 1e-6;
        const BodyMotion<double> to = model.advance(from, from.steer, net, kShort);
        const auto change = model.change(from);
        // change() rounds its corners off, by some hundredths.
        EXPECT_NEAR((to.vx - from.vx) / kShort, change.vx, 0.05) << i << ' ' << net;
        EXPECT_NEAR((to.vy - from.vy) / kShort, change.vy, 0.05) << i << ' ' << net;
        EXPECT_NEAR((to.r - from.r) / kShort, change.r, 0.05) << i << ' ' << net;
      }
    }
  }
}

/// A car at 20 m/s all of whose wheels have this slip angle [rad].
BodyMotion<double> slipping(double slip, double acceleration) {
  return {.vx = 20.0, .vy = -20.0 * slip, .acceleration = acceleration};
}

TEST(PredictionModel, LosesForceWhereAnInnerWheelGivesNoMore) {
  VehicleParams free_rolling = road_car_params();
  free_rolling.drag_constant = free_rolling.drag_quadratic = 0.0;
  const PredictionModel model(free_rolling);
  const auto forward = [&](double slip, double net) { return model.change(slipping(slip, net)).vx; };
  EXPECT_NEAR(forward(0.0, 4.5), 4.5, 0.01) << "all wheels hold on a straight";
  EXPECT_LT(forward(0.09, 4.5), 4.4) << "an inner wheel spins in a bend";
  EXPECT_GT(forward(0.05, -9.5), -9.4) << "or its anti-lock lets go";
  // The outer wheels go on pulling or braking: into the bend, and out of it. Beside that loss, only the front
  // wheels turn a car without slip at the rear.
  const auto turn = [&](double steer, double net) {
    const VehicleParams& car = model.vehicle();
    const auto change = model.change(BodyMotion<double>{.vx = 20.0, .steer = steer, .acceleration = net});
    return change.r - car.mass / car.yaw_inertia * car.front_axle * change.vy;
  };
  EXPECT_NEAR(turn(0.15, 1.0), 0.0, 0.01);
  for (const double side : {1.0, -1.0}) {
    EXPECT_GT(side * turn(0.15 * side, 9.0), 0.05);
    EXPECT_LT(side * turn(0.15 * side, -9.5), -0.2);
    EXPECT_DOUBLE_EQ(turn(0.15 * side, 9.0), side * turn(0.15, 9.0));
  }
}

TEST(PredictionModel, KnowsThatAnInnerWheelIsUnloadedInABend) {
  const PredictionModel model(road_car_params());
  const auto straight = model.tire_use(slipping(0.0, 4.0));
  for (const double side : {1.0, -1.0})
    EXPECT_GT(model.tire_use(slipping(0.07 * side, 4.0)).along_front, 1.3 * straight.along_front);
}

/// A car that turns without slip angles has no lateral acceleration.
TEST(PredictionModel, MovesLoadByTheForceOfTheTyres) {
  const VehicleParams car = road_car_params();
  const PredictionModel model(car);
  for (const double side : {1.0, -1.0}) {
    BodyMotion<double> turning{.vx = 20.0, .r = 0.5 * side, .acceleration = 4.0};
    turning.steer = car.wheelbase() * turning.r / 20.0;
    turning.vy = car.rear_axle * turning.r;
    EXPECT_NEAR(model.tire_use(turning).along_front, model.tire_use(slipping(0.0, 4.0)).along_front, 1e-3);
  }
}

TEST(WithGrip, GivesThatShareOfTheTyresForcesAtTheSameSlip) {
  const VehicleParams car = road_car_params();
  EXPECT_EQ(with_grip(car, 1.0), car);
  const PredictionModel told(car);
  const PredictionModel slippery(with_grip(car, 0.7));
  for (const double steer : {-0.08, 0.01, 0.05}) {
    const BodyMotion<double> rolling{25.0, 0.0, 0.0, steer, 0.0};
    const double force = told.change(rolling).vy;
    EXPECT_NEAR(slippery.change(rolling).vy / force, 0.7, 0.01) << steer;
  }
}

}  // namespace
}  // namespace chicane::model
