// SPDX-License-Identifier: MIT
#include "chicane/lap_time/minimum_time.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "chicane/base/angle.hpp"
#include "chicane/lap_time/detail/limit_car.hpp"

namespace chicane::lap_time {
namespace {

constexpr double kWidth = 5.0;  // to each side [m]

path::Track circle(double radius) {
  std::vector<path::TrackPoint> points;
  for (int i = 0; i < 120; ++i) {
    const double angle = 2.0 * kPi * i / 120.0;
    points.push_back({{radius * std::cos(angle), radius * std::sin(angle)}, kWidth, kWidth});
  }
  return *path::Track::create("circle", points, true, {.smoothing_sigma = 0.0});
}

/// A closed road with corners to both sides, one side wider than the other; `side` −1 mirrors it.
path::Track bean(double side) {
  std::vector<path::TrackPoint> points;
  for (int i = 0; i < 140; ++i) {
    const double angle = 2.0 * kPi * i / 140.0;
    const double radius = 75.0 + 25.0 * std::cos(2.0 * angle) + 12.0 * std::sin(3.0 * angle);
    path::TrackPoint point{{radius * std::cos(angle), side * radius * std::sin(angle)}, 4.0, 5.0};
    if (side < 0.0) std::swap(point.left, point.right);
    points.push_back(point);
  }
  return *path::Track::create("bean", points, true);
}

const Limit& bean_limit() {
  static const Limit limit = *find_limit(bean(1.0), model::road_car_params());
  return limit;
}

/// The car at the inner edge of a circle, as fast as its worse axle can: bisection on eq. 3–6.
double circle_time(double radius, const LimitCar& car) {
  double low = 1.0;
  double high = 60.0;
  double time = 0.0;
  for (int i = 0; i < 100; ++i) {
    const double v = 0.5 * (low + high);
    double inside = radius;
    for (int turn = 0; turn < 50; ++turn) {  // how far in the body fits depends on how far in it is
      const double kappa = 1.0 / inside;
      const double lean = kappa * (car.slip_heading * v * v / car.load(v) - car.rear_axle);
      const double room = kWidth - car.half_width;
      const double front = room + 0.5 * car.front_axle * car.front_axle / radius - car.front_axle * lean;
      const double rear = room + 0.5 * car.rear_axle * car.rear_axle / radius + car.rear_axle * lean;
      inside = radius - std::min(front, rear);
    }
    const double lateral = v * v / inside;
    const double force = car.drag(v) + car.slip_drag * lateral * lateral / car.load(v);
    const double along = force / car.grip(v);
    const double across = car.stay * lateral / car.grip(v);
    // An axle's grip, what it drives with, and what its inner wheel carries.
    const auto used = [&](double shift, double part, double roll) {
      const double grip = (1.0 + shift * force) * (1.0 - car.sensitivity * shift * force);
      const double sideways = across / grip;
      const double forward = part * along / (grip * (1.0 - roll * lateral));
      return sideways * sideways + car.coupling * forward * forward;
    };
    const double use = std::max(used(-car.front_shift, car.front_part * car.drive_front, car.front_roll),
                                used(car.rear_shift, car.rear_part * (1.0 - car.drive_front), car.rear_roll));
    (use > 1.0 ? high : low) = v;
    time = 2.0 * kPi * inside / v;
  }
  return time;
}

TEST(MinimumTime, OnACircleItIsTheInnerEdgeAtTheGripOfTheWorseAxle) {
  const model::VehicleParams road_car = model::road_car_params();
  const Result<Limit> limit = find_limit(circle(60.0), road_car);
  ASSERT_TRUE(limit) << limit.error().message;
  // The search ends when rounds change the time by 5e-5, and lets the constraints give by as little.
  EXPECT_NEAR(limit->times.lap / circle_time(60.0, LimitCar(road_car)), 1.0, 2e-3);
  EXPECT_NEAR(limit->top_speed, limit->least_speed, 0.05);
}

TEST(MinimumTime, AMirroredRoadHasTheMirroredLine) {
  const Result<Limit> mirrored = find_limit(bean(-1.0), model::road_car_params());
  ASSERT_TRUE(mirrored) << mirrored.error().message;
  const Limit& limit = bean_limit();
  EXPECT_NEAR(mirrored->times.lap, limit.times.lap, 1e-4 * limit.times.lap);
  ASSERT_EQ(mirrored->line.size(), limit.line.size());
  for (std::size_t i = 0; i < limit.line.size(); ++i)
    ASSERT_NEAR(mirrored->line[i].d, -limit.line[i].d, 0.1) << i;
}

TEST(MinimumTime, ACoarserGridChangesLittle) {
  const Result<Limit> coarser = find_limit(bean(1.0), model::road_car_params(), {.spacing = 3.0});
  ASSERT_TRUE(coarser) << coarser.error().message;
  EXPECT_NEAR(coarser->times.lap / bean_limit().times.lap, 1.0, 2e-3);  // first order in the spacing
}

TEST(MinimumTime, TheLineIsACurveThatIsDrivenAsFastAsItSays) {
  const std::vector<path::LinePoint>& line = bean_limit().line;
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const Vec2 before = line[i].position - line[i - 1].position;
    const Vec2 after = line[i + 1].position - line[i].position;
    const double turn =
        angle_difference(std::atan2(after.y(), after.x()), std::atan2(before.y(), before.x()));
    const double length = 0.5 * (before.norm() + after.norm());
    // Curvature changes by up to 0.02 1/m² on a stage of 2 m.
    ASSERT_NEAR(turn / length, line[i].curvature, 6e-3) << "at " << line[i].s;
    const double time = line[i + 1].time - line[i].time;
    // A stage takes the road in its middle for all of it: up to 1.5 % where the road's curvature changes.
    ASSERT_NEAR(after.norm() / time, 0.5 * (line[i].speed + line[i + 1].speed), 0.4) << "at " << line[i].s;
    const double gained = (line[i + 1].speed - line[i].speed) / time;
    const double told = 0.5 * (line[i].longitudinal_acceleration + line[i + 1].longitudinal_acceleration);
    ASSERT_NEAR(gained, told, 0.3) << "at " << line[i].s;
  }
}

/// Fastest speed on the line as it is, from its own curvature: no optimisation of where to drive.
double quasi_steady_time(const std::vector<path::LinePoint>& line, const model::VehicleParams& p) {
  const LimitCar car(p);
  const std::size_t count = line.size() - 1;
  const auto gap = [&](std::size_t i) { return (line[i + 1].position - line[i].position).norm(); };
  std::vector<double> demand(count);
  std::vector<double> v(count, 80.0);
  for (std::size_t i = 0; i < count; ++i) {
    const double slope = (line[(i + 1) % count].curvature - line[i].curvature) / gap(i);
    const double front = std::fabs(car.stay * line[i].curvature + car.front_turn * slope);
    const double rear = std::fabs(car.stay * line[i].curvature - car.rear_turn * slope);
    demand[i] = std::max({front, rear, 1e-6});
    v[i] = std::min(v[i], std::sqrt(car.grip_0 / demand[i]));
  }
  const auto left = [&](std::size_t i, double speed) {
    const double use = speed * speed * demand[i] / car.grip(speed);
    return car.grip(speed) * std::sqrt(std::max(0.0, 1.0 - car.coupling * use * use));
  };
  const auto drag = [&](std::size_t i, double speed) {
    const double lateral = speed * speed * line[i].curvature;
    return car.drag(speed) + car.slip_drag * lateral * lateral / car.load(speed);
  };
  for (std::size_t turn = 0; turn < 2 * count; ++turn) {
    const std::size_t i = turn % count;
    const double force = std::min({car.drive, car.power / v[i], left(i, v[i])});
    const double square = v[i] * v[i] + 2.0 * gap(i) * (force - drag(i, v[i]));
    v[(i + 1) % count] = std::min(v[(i + 1) % count], std::sqrt(square));
  }
  for (std::size_t turn = 2 * count; turn-- > 0;) {
    const std::size_t i = turn % count;
    const std::size_t ahead = (i + 1) % count;
    const double force = std::min(car.brake, left(ahead, v[ahead]));
    v[i] = std::min(v[i], std::sqrt(v[ahead] * v[ahead] + 2.0 * gap(i) * (force + drag(ahead, v[ahead]))));
  }
  double time = 0.0;
  for (std::size_t i = 0; i < count; ++i) time += 2.0 * gap(i) / (v[i] + v[(i + 1) % count]);
  return time;
}

TEST(MinimumTime, AForwardBackwardPassOnItsLineAgrees) {
  const Limit& limit = bean_limit();
  const double time = quasi_steady_time(limit.line, model::road_car_params());
  // Load transfer and the axles' shares of the force are left out of the pass, and the forces may jump in it.
  EXPECT_NEAR(time / limit.times.lap, 1.0, 3e-2);
}

TEST(MinimumTime, SectorsAddUpAndTheLapIsClosed) {
  const Limit& limit = bean_limit();
  EXPECT_NEAR(limit.times.sectors[0] + limit.times.sectors[1] + limit.times.sectors[2], limit.times.lap,
              1e-9);
  EXPECT_NEAR(limit.line.back().time, limit.times.lap, 1e-9);
  EXPECT_LT((limit.line.back().position - limit.line.front().position).norm(), 0.3);
  EXPECT_LT(limit.report.violation, 0.05);
}

TEST(MinimumTime, MoreGripIsFasterAndLessRoadIsSlower) {
  model::VehicleParams grippy = model::road_car_params();
  grippy.friction *= 1.1;
  const Result<Limit> faster = find_limit(bean(1.0), grippy);
  ASSERT_TRUE(faster) << faster.error().message;
  EXPECT_LT(faster->times.lap, 0.99 * bean_limit().times.lap);
  model::VehicleParams wide = model::road_car_params();
  wide.height *= (wide.track_width + 2.0) / wide.track_width;  // the same load moves to its outer wheels
  wide.track_width += 2.0;
  const Result<Limit> slower = find_limit(bean(1.0), wide);
  ASSERT_TRUE(slower) << slower.error().message;
  EXPECT_GT(slower->times.lap, bean_limit().times.lap);
}

TEST(MinimumTime, RefusesWhatHasNoLimitAndSaysWhy) {
  const model::VehicleParams car = model::road_car_params();
  std::vector<path::TrackPoint> straight;
  for (int i = 0; i < 10; ++i) straight.push_back({{20.0 * i, 0.0}, 4.0, 4.0});
  const Result<Limit> open = find_limit(*path::Track::create("strip", straight, false), car);
  ASSERT_FALSE(open);
  EXPECT_NE(open.error().message.find("strip: the road is open"), std::string::npos);

  model::VehicleParams wide = car;
  wide.track_width = 10.0;  // and the tyres: more than the road
  const Result<Limit> narrow = find_limit(circle(60.0), wide);
  ASSERT_FALSE(narrow);
  EXPECT_NE(narrow.error().message.find("10.00 m wide"), std::string::npos) << narrow.error().message;

  EXPECT_FALSE(find_limit(circle(60.0), car, {.spacing = 0.1}));
  wide.track_width = -1.0;
  EXPECT_FALSE(find_limit(circle(60.0), wide));
  const Result<Limit> hasty = find_limit(circle(60.0), car, {.most_rounds = 2});
  ASSERT_FALSE(hasty);
  EXPECT_NE(hasty.error().message.find("no optimum after 2 rounds"), std::string::npos);
}

TEST(MinimumTime, RefusesAModelCar) {
  model::VehicleParams car = model::road_car_params();
  car.scale = 0.1;
  const Result<Limit> limit = find_limit(circle(60.0), car);
  ASSERT_FALSE(limit);
  EXPECT_EQ(limit.error().message, "limit: got a model car of scale 0.1, expected one in full size");
}

TEST(MinimumTime, CanBeStopped) {
  int rounds = 0;
  LimitOptions options;
  options.go_on = [&](int, double) { return ++rounds < 3; };
  EXPECT_FALSE(find_limit(circle(60.0), model::road_car_params(), options));
  EXPECT_EQ(rounds, 3);
}

}  // namespace
}  // namespace chicane::lap_time
