// SPDX-License-Identifier: MIT
#include "sim/single_track.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "chicane/base/random.hpp"

namespace chicane::sim::experiment {
namespace {

using model::VehicleParams;
using State7 = SingleTrack::StateOf<double>;

std::array<VehicleParams, 2> cars() { return {model::udacity_params(), model::road_car_params()}; }

template <class T>
std::array<T, 7> flat(const SingleTrack::StateOf<T>& s) {
  return {s.x, s.y, s.psi, s.motion.vx, s.motion.vy, s.motion.r, s.steer};
}

template <class T>
SingleTrack::StateOf<T> unflat(const std::array<T, 7>& x) {
  return {.x = x[0], .y = x[1], .psi = x[2], .motion = {.vx = x[3], .vy = x[4], .r = x[5]}, .steer = x[6]};
}

/// Derivative with respect to (x, y, ψ, vx, vy, r, δ, steering rate, acceleration).
template <class T>
std::array<T, 7> derivative(const SingleTrack& model, const std::array<T, 9>& point) {
  std::array<T, 7> x;
  for (std::size_t i = 0; i < 7; ++i) x[i] = point[i];
  return flat(model.derivative(unflat(x), point[7], point[8]));
}

TEST(SingleTrack, JetJacobianEqualsCentralDifferences) {
  Random random{11};
  for (const VehicleParams& car : cars()) {
    const SingleTrack model{car};
    for (int trial = 0; trial < 200; ++trial) {
      const double v = random.uniform(-5.0, 50.0);
      std::array<double, 9> point{random.uniform(-100, 100), random.uniform(-100, 100),
                                  random.uniform(-4, 4),     v,
                                  random.uniform(-3, 3),     random.uniform(-1, 1),
                                  random.uniform(-0.4, 0.4), random.uniform(-1, 1),
                                  random.uniform(-9, 5)};
      std::array<FullJet<9>, 9> jets;
      for (std::size_t i = 0; i < 9; ++i) jets[i] = FullJet<9>::variable(point[i], static_cast<int>(i));
      const std::array<FullJet<9>, 7> exact = derivative(model, jets);
      for (std::size_t i = 0; i < 9; ++i) {
        constexpr double kStep = 1e-5;
        std::array<double, 9> above = point;
        std::array<double, 9> below = point;
        above[i] += kStep;
        below[i] -= kStep;
        const std::array<double, 7> f = derivative(model, above);
        const std::array<double, 7> g = derivative(model, below);
        for (std::size_t row = 0; row < 7; ++row) {
          const double difference = (f[row] - g[row]) / (2.0 * kStep);
          // Central differences err by kStep² times a third derivative of up to about 1e3, and rounding 1e-16
          // · 100 / kStep.
          EXPECT_NEAR(exact[row].slopes[i], difference, 1e-6 * (1.0 + std::fabs(difference)))
              << car.name << " row " << row << " column " << i << " v " << v;
        }
      }
    }
  }
}

TEST(SingleTrack, MirrorsWhenSignsFlip) {
  Random random{5};
  for (const VehicleParams& car : cars()) {
    const SingleTrack model{car};
    for (int trial = 0; trial < 100; ++trial) {
      const BodyMotion<double> motion{random.uniform(0, 50), random.uniform(-3, 3), random.uniform(-1, 1)};
      const double steer = random.uniform(-0.4, 0.4);
      const BodyMotion<double> left = model.derivative(motion, steer, 1.0);
      const BodyMotion<double> right =
          model.derivative(BodyMotion<double>{motion.vx, -motion.vy, -motion.r}, -steer, 1.0);
      EXPECT_EQ(left.vx, right.vx);  // the same operations with other signs: the same bits
      EXPECT_EQ(left.vy, -right.vy);
      EXPECT_EQ(left.r, -right.r);
    }
  }
}

TEST(SingleTrack, DoesNotKnowWhereNorIs) {
  const SingleTrack model{model::udacity_params()};
  const BodyMotion<double> motion{20.0, 0.3, 0.2};
  State7 here{.x = 0.0, .y = 0.0, .psi = 0.0, .motion = motion, .steer = 0.1};
  State7 there{.x = 512.0, .y = -64.0, .psi = 1.2, .motion = motion, .steer = 0.1};
  const State7 a = model.derivative(here, 0.0, 1.0);
  const State7 b = model.derivative(there, 0.0, 1.0);
  EXPECT_EQ(a.motion.vy, b.motion.vy);
  EXPECT_EQ(a.motion.r, b.motion.r);
  // The velocity turns along with the car; rounding of one rotation of 20 m/s.
  EXPECT_NEAR(b.x, std::cos(1.2) * a.x - std::sin(1.2) * a.y, 1e-13);
  EXPECT_NEAR(b.y, std::sin(1.2) * a.x + std::cos(1.2) * a.y, 1e-13);
}

TEST(SingleTrack, CrawlsOnTheKinematicCircle) {
  for (const VehicleParams& car : cars()) {
    const SingleTrack model{car};
    const double steer = 0.2;
    BodyMotion<double> motion{0.5, 0.0, 0.0};
    for (int i = 0; i < 500; ++i) {
      motion = advance(model, motion, steer, 0.0, 0.02);
      motion.vx = 0.5;
    }
    // The tyres slip by (1 − h) r v / (C g) · v₀, about 3e-4 m/s sideways: 6e-3 of vy, and nearly the same at
    // both axles.
    EXPECT_NEAR(motion.r, 0.5 * std::tan(steer) / car.wheelbase(), 1e-3 * motion.r) << car.name;
    EXPECT_NEAR(motion.vy, car.rear_axle * motion.r, 7e-3 * motion.vy) << car.name;
  }
}

TEST(SingleTrack, TurnsAtTheSteadyYawRateOfLinearTheory) {
  for (const VehicleParams& car : cars()) {
    const SingleTrack model{car};
    const double v = 25.0;
    const double steer = 0.004;  // linear: slips of 1e-3
    BodyMotion<double> motion{v, 0.0, 0.0};
    for (int i = 0; i < 2000; ++i) {
      motion = advance(model, motion, steer, 0.0, 0.01);
      motion.vx = v;
    }
    const double effective_v = std::sqrt(v * v + SingleTrack::kSlipSpeed * SingleTrack::kSlipSpeed);
    const double understeer = (1.0 / car.cornering_front - 1.0 / car.cornering_rear) *
                              (1.0 - car.steer_helper) / (car.load_constant + car.load_per_speed * v);
    // δ = L r / v + K (1 − h) v r · (regularised v / v): eq. 8.
    const double expected = steer / (car.wheelbase() / v + understeer * effective_v);
    EXPECT_NEAR(motion.r, expected, 2e-3 * expected)
        << car.name;  // δ² and α² terms left out by the linear theory
  }
}

TEST(SingleTrack, StandsStillWithoutCommands) {
  for (const VehicleParams& car : cars()) {
    const SingleTrack model{car};
    const BodyMotion<double> rate = model.derivative(BodyMotion<double>{}, 0.3, 0.0);
    EXPECT_EQ(rate.vx, 0.0);
    EXPECT_EQ(rate.vy, 0.0);
    EXPECT_EQ(rate.r, 0.0);
  }
}

TEST(SingleTrack, StaysBoundedAtEverySpeedWithStepsOf40Milliseconds) {
  for (const VehicleParams& car : cars()) {
    const SingleTrack model{car};
    for (double v : {0.0, 0.1, 1.0, 2.0, 3.0, 5.0, 10.0, 30.0, 50.0}) {
      BodyMotion<double> motion{v, 0.5, 0.3};
      for (int i = 0; i < 1000; ++i) {
        motion = advance(model, motion, 0.0, 0.0, 0.04);
        motion.vx = v;
      }
      EXPECT_LT(std::fabs(motion.vy), 1e-6) << car.name << " at " << v;  // 40 s: everything has died down
      EXPECT_LT(std::fabs(motion.r), 1e-6) << car.name << " at " << v;
    }
  }
}

TEST(SingleTrack, SidewaysForceNeverExceedsFrictionTimesLoad) {
  const SingleTrack model{model::road_car_params()};
  const double v = 30.0;
  const auto force = model.axle_forces(BodyMotion<double>{v, -20.0, 0.0}, 0.4);
  EXPECT_LE(force.front + force.rear, model.params.friction * model.load(v));
  EXPECT_GT(force.front + force.rear, 0.99 * model.params.friction * model.load(v));
}

}  // namespace
}  // namespace chicane::sim::experiment
