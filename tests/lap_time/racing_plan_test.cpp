// SPDX-License-Identifier: MIT
#include "chicane/lap_time/racing_plan.hpp"

#include "chicane/base/math.hpp"
#include "chicane/lap_time/detail/collocation.hpp"
#include "chicane/lap_time/detail/limit_model.hpp"
#include "chicane/lap_time/detail/plant_models.hpp"
#include "chicane/lap_time/limit.hpp"

#include "support/chicane_test.hpp"
#include "support/roads.hpp"
#include "support/stadium.hpp"

namespace chicane::lap_time {
namespace {

/// Checks values, Jacobian and weighted Hessian of a node's functions at `z` against central differences.
void expect_derivatives_of_differences(const NodeFunctions& f, int node, const std::vector<double>& z) {
  const auto n = static_cast<std::size_t>(f.variables);
  const auto m = static_cast<std::size_t>(f.functions());
  std::vector<double> weights(m);
  for (std::size_t i = 0; i < m; ++i) weights[i] = 0.3 + 0.1 * static_cast<double>(i % 7);
  std::vector<double> out(m), low(m), high(m), jacobian(m * n), slopes_low(m * n), slopes_high(m * n);
  std::vector<double> hessian(n * (n + 1) / 2), other(n * (n + 1) / 2);
  f.derivatives(node, z.data(), weights.data(), out.data(), jacobian.data(), hessian.data());
  f.values(node, z.data(), low.data());
  for (std::size_t i = 0; i < m; ++i) EXPECT_NEAR(out[i], low[i], 1e-12 * (1.0 + std::fabs(low[i])));
  for (std::size_t j = 0; j < n; ++j) {
    const double step = 1e-5 * f.scale[j];
    std::vector<double> moved = z;
    moved[j] = z[j] - step;
    f.derivatives(node, moved.data(), weights.data(), low.data(), slopes_low.data(), other.data());
    moved[j] = z[j] + step;
    f.derivatives(node, moved.data(), weights.data(), high.data(), slopes_high.data(), other.data());
    for (std::size_t i = 0; i < m; ++i) {
      const double slope = (high[i] - low[i]) / (2.0 * step);
      // Central differences of second order: a millionth of the function's size by scaled steps of 1e-5.
      EXPECT_NEAR(jacobian[i * n + j], slope, 1e-5 * (std::fabs(slope) + 1.0 / f.scale[j])) << i << ' ' << j;
    }
    for (std::size_t i = 0; i <= j; ++i) {
      double bent = 0.0;
      for (std::size_t k = 0; k < m; ++k)
        bent += weights[k] * (slopes_high[k * n + i] - slopes_low[k * n + i]) / (2.0 * step);
      EXPECT_NEAR(hessian[j * (j + 1) / 2 + i], bent,
                  1e-4 * (std::fabs(bent) + 1.0 / (f.scale[i] * f.scale[j])))
          << i << ' ' << j;
    }
  }
}

/// A closed road with corners to both sides, one side wider than the other; `side` −1 mirrors it.
road::Track bean(double side = 1.0, double half_width = 4.0) {
  return test::bean_road(side, 1.0, half_width, 1.2 * half_width);
}

model::VehicleParams car_named(const std::string& name) {
  return name == "udacity" ? model::udacity_params() : model::road_car_params();
}

class RacingPlanOf : public testing::TestWithParam<const char*> {
 protected:
  /// Without reserve, computed once for all tests of a process.
  static const auto& plan_without_reserve() {
    static std::map<std::string, decltype(plan_racing_line(bean(), model::VehicleParams{}))> plans;
    const auto found = plans.find(GetParam());
    if (found != plans.end()) return found->second;
    return plans.emplace(GetParam(), plan_racing_line(bean(), car_named(GetParam()))).first->second;
  }
};

TEST_P(RacingPlanOf, ItsModelHasTheDerivativesOfDifferences) {
  VehicleModel vehicle;
  vehicle.model.set_vehicle(car_named(GetParam()));
  RoadNodes road = lay_nodes(bean(), {}, 0.1);
  vehicle.road = &road;
  vehicle.stability = model::BrakingStability(car_named(GetParam()));
  vehicle.is_steered_slowly = car_named(GetParam()).friction_coupling > 0.0;
  vehicle.sliding = model::SlidingBound(car_named(GetParam()));
  vehicle.slides = vehicle.sliding.permits();
  const ModelFunctions<VehicleModel> f(vehicle);
  // Coasting, braking and driving in bends to both sides.
  for (const double side : {1.0, -1.0}) {
    for (const double net : {-6.0, -0.2, 0.1, 3.5}) {
      SCOPED_TRACE(net * side);
      expect_derivatives_of_differences(
          f, 3, {0.4, 0.03 * side, 22.0, -0.6 * side, 0.36 * side, 0.06 * side, net, 0.1, 4.0});
    }
  }
}

/// By how much a plan brakes harder in bends than leaves a pole of kMostPole [m/s²].
double most_excess_of_braking(const road::RacingLine& plan, const model::VehicleParams& car) {
  const model::BrakingStability stability(car);
  double most = -100.0;
  for (const road::RacingLinePoint& at : plan.points) {
    const double drag = car.drag_constant + car.drag_quadratic * at.vx * at.vx;
    const double use = stability.use(std::fabs(at.vx * at.yaw_rate), at.vx);
    const double force =
        at.vy * at.yaw_rate - at.acceleration - drag;  // and what the front wheels' turn adds
    most = std::max(most, force - stability.most_braking(at.vx, use));
  }
  return most;
}

TEST(RacingPlan, BrakesNoHarderThanASlowSteeringCanCatch) {
  model::VehicleParams van = model::road_car_params();
  van.front_axle = 1.15;
  van.rear_axle = 1.32;
  van.height = 0.75;
  van.brake_share_front = 0.64;
  const RacingPlanOptions options{.margin = 0.25, .grip_share = 0.93, .time_step = 0.12};
  const auto quick = test::good(plan_racing_line(bean(), van, options));
  EXPECT_GT(most_excess_of_braking(*quick, van), 1.5);
  van.steer_rate_limit = 0.4;
  const auto slow = test::good(plan_racing_line(bean(), van, options));
  EXPECT_LT(most_excess_of_braking(*slow, van), 1.0);
}

TEST_P(RacingPlanOf, WithoutReserveIsAsFastAsThePlantCanBe) {
  const auto& plan = plan_without_reserve();
  ASSERT_TRUE(plan) << plan.error().message;
  const auto limit =
      test::good(find_plant_limit(bean(), GetParam(), {}, {.time_step = 0.1, .wants_witness = false}));
  EXPECT_NEAR(plan->lap_time() / limit->bound.lap, 1.0, 0.025);
}

TEST_P(RacingPlanOf, KeepsWhatItIsToldToAndMirrors) {
  const RacingPlanOptions reserve{.margin = 0.3, .grip_share = 0.9, .brake_share = 0.9};
  const model::VehicleParams car = car_named(GetParam());
  const road::Track track = bean();
  const auto plan = plan_racing_line(track, car, reserve);
  const auto& free = plan_without_reserve();
  const auto mirrored = plan_racing_line(bean(-1.0), car, reserve);
  ASSERT_TRUE(plan && free && mirrored);
  EXPECT_GT(plan->lap_time(), 1.002 * free->lap_time());
  EXPECT_NEAR(mirrored->lap_time() / plan->lap_time(), 1.0, 1e-3);
  const double beside = 0.5 * (car.track_width + car.tire_width);
  double least = 100.0;
  for (const road::RacingLinePoint& p : plan->points) {
    for (const double x : {car.front_axle, -car.rear_axle}) {
      // To first order in the small angles; the bend takes the rest.
      const double middle = p.offset + x * p.heading;
      least = std::min(
          {least, track.left_width(p.s + x) - middle - beside, track.right_width(p.s + x) + middle - beside});
    }
  }
  EXPECT_GT(least, 0.15);
  EXPECT_LT(least, 0.4) << "it uses the road";
}

TEST_P(RacingPlanOf, UsesNoMoreSlipThanItIsToldTo) {
  const model::VehicleParams car = car_named(GetParam());
  const auto most_slip = [&](double share) {
    const auto plan = plan_racing_line(bean(), car, {.slip_share = share});
    EXPECT_TRUE(plan) << share;
    double most = 0.0;
    for (const road::RacingLinePoint& p : plan->points)
      most = std::max(most, std::abs(std::atan2(p.vy - car.rear_axle * p.yaw_rate, p.vx)));
    return most;
  };
  EXPECT_LT(most_slip(0.6), 0.85 * most_slip(1.0)) << "of the rear axle";
}

/// docs/limit.md: the rear slides as far as the closed loop is stable, the front keeps its slope.
TEST(RacingPlan, SlidesWhereThatIsFasterAndStable) {
  const model::VehicleParams car = model::udacity_params();
  const road::Track tight = *road::Track::create(
      "two hairpins", test::with_widths(test::even_stadium(52, 14.0, 60.0), 4.0, 4.0), true);
  const auto grips = plan_racing_line(tight, car);
  const auto slides = plan_racing_line(tight, car, {.slides = true});
  const auto late = plan_racing_line(tight, car, {.slides = true, .delay = 0.4});
  ASSERT_TRUE(grips && slides && late);
  EXPECT_LT(slides->lap_time(), 0.995 * grips->lap_time());
  EXPECT_EQ(late->lap_time(), grips->lap_time()) << "with that delay it is not stable";
  const model::SlidingBound bound(car);
  const model::PredictionModel model(car);
  double most = 0.0;
  for (const road::RacingLinePoint& p : slides->points) {
    const auto use =
        model.tire_use(model::BodyMotion<double>{p.vx, p.vy, p.yaw_rate, p.steer, p.acceleration});
    EXPECT_LT(use.front, bound.front() + 0.01);
    EXPECT_LT(use.rear, bound.rear(p.vx) + 0.01);
    most = std::max(most, use.rear);
  }
  EXPECT_GT(most, 1.2);
}

TEST_P(RacingPlanOf, IsTheSameEachTime) {
  const auto& one = plan_without_reserve();
  const auto two = plan_racing_line(bean(), car_named(GetParam()));
  ASSERT_TRUE(one && two);
  ASSERT_EQ(one->points.size(), two->points.size());
  for (std::size_t i = 0; i < one->points.size(); ++i) EXPECT_EQ(one->points[i].vx, two->points[i].vx);
}

TEST_P(RacingPlanOf, KeepsToASpeedLimit) {
  const auto plan = test::good(plan_racing_line(bean(), car_named(GetParam()), {.speed_limit = 15.0}));
  for (const road::RacingLinePoint& p : plan->points) EXPECT_LE(p.vx, 15.01);
}

INSTANTIATE_TEST_SUITE_P(Cars, RacingPlanOf, testing::Values("udacity", "road-car"), [](const auto& param) {
  return std::string(param.param) == "udacity" ? "Udacity" : "RoadCar";
});

TEST(RacingPlan, SaysWhyThereIsNone) {
  EXPECT_THAT(test::refusal_of(plan_racing_line(bean(1.0, 0.9), model::udacity_params())), HasSubstr("road"));
  EXPECT_FALSE(plan_racing_line(bean(), model::udacity_params(), {.grip_share = 0.0}));
  EXPECT_FALSE(plan_racing_line(bean(), model::udacity_params(), {.margin = -0.1}));
}

TEST(RacingPlan, SaysWhetherALapCanBeDriven) {
  EXPECT_TRUE(can_be_driven(bean(), model::road_car_params(), 4.0, 1.0));
  EXPECT_THAT(test::refusal_of(can_be_driven(bean(1.0, 0.7), model::road_car_params(), 4.0, 1.0)),
              StartsWith("the road is "));
  const road::Track open =
      road::Track::create("open", std::vector<road::TrackPoint>(bean(1.0, 0.7).raw_points()), false).value();
  EXPECT_TRUE(can_be_driven(open, model::road_car_params(), 4.0, 1.0)) << "it need not come round";
}

TEST(RacingPlan, EntersAnOpenRoadAsItLeavesIt) {
  std::vector<road::TrackPoint> points;  // a quarter of a circle between two straights
  for (int i = 0; i < 20; ++i) points.push_back({{10.0 * i, 0.0}, 4.0, 4.0});
  for (int i = 1; i <= 10; ++i) {
    const double angle = 0.5 * kPi * i / 10.0;
    points.push_back({{190.0 + 40.0 * std::sin(angle), 40.0 - 40.0 * std::cos(angle)}, 4.0, 4.0});
  }
  for (int i = 1; i < 15; ++i) points.push_back({{230.0, 40.0 + 10.0 * i}, 4.0, 4.0});
  const road::Track track = road::Track::create("open", points, false).value();
  const auto plan = test::good(plan_racing_line(track, model::road_car_params()));
  const road::RacingLinePoint &first = plan->points.front(), &last = plan->points.back();
  EXPECT_NEAR(last.s, track.length(), 1e-9);
  EXPECT_EQ(first.vx, last.vx);
  EXPECT_EQ(first.offset, last.offset);
  double slowest = first.vx;
  for (const road::RacingLinePoint& p : plan->points) slowest = std::min(slowest, p.vx);
  EXPECT_LT(slowest, first.vx - 3.0) << "the bend";
}

// What model tracks have: maps of F1TENTH are 22 m wide in full size, around bends of 10 m.
TEST(RacingPlan, TakesARoadThatIsWiderThanItsBendsAreTight) {
  constexpr double kHalfWidth = 10.0;
  const road::Track track = *road::Track::create(
      "wide", test::with_widths(test::even_stadium(96, 9.0, 140.0), kHalfWidth, kHalfWidth), true);
  for (const std::string name : {"udacity", "road-car"}) {
    const auto plan =
        test::good(plan_racing_line(track, car_named(name), {.margin = 0.25, .grip_share = 0.93}));
    for (const road::RacingLinePoint& p : plan->points) {
      const double bend = track.centre().at(p.s).curvature;
      EXPECT_GT(1.0 - bend * p.offset, 0.0) << name << ": beyond the bend's centre at s = " << p.s;
      EXPECT_LT(std::fabs(p.offset), kHalfWidth) << name;
    }
  }
}

TEST(RacingPlan, StopsWhenToldTo) {
  int told = 0;
  const auto plan =
      plan_racing_line(bean(), model::udacity_params(), {.go_on = [&](int, double) { return ++told < 5; }});
  EXPECT_FALSE(plan);
  EXPECT_EQ(told, 5);
}

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
