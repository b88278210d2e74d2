// SPDX-License-Identifier: MIT
#include "chicane/model/kinematic_bicycle.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "chicane/base/angle.hpp"
#include "chicane/base/random.hpp"

namespace chicane::model {
namespace {

using State4 = KinematicBicycle::StateOf<double>;

TEST(KinematicBicycle, OneStepIsTheDescribedEulerStep) {
  const KinematicBicycle model{.length = 2.67};
  const State4 next = model.step(State4{1.0, 2.0, 0.3, 10.0}, 0.1, -2.0, 0.1);
  EXPECT_NEAR(next.x, 1.0 + 10.0 * std::cos(0.3) * 0.1, 1e-14);
  EXPECT_NEAR(next.y, 2.0 + 10.0 * std::sin(0.3) * 0.1, 1e-14);
  EXPECT_NEAR(next.psi, 0.3 + 10.0 * 0.1 / 2.67 * 0.1, 1e-15);
  EXPECT_NEAR(next.v, 9.8, 1e-14);
}

TEST(KinematicBicycle, SteeringSignsAreMirrorImages) {
  const KinematicBicycle left{.length = 2.67, .steering_sign = 1.0};
  const KinematicBicycle right{.length = 2.67, .steering_sign = -1.0};
  const State4 a = left.step(State4{0, 0, 0, 10}, 0.2, 0.0, 0.1);
  const State4 b = right.step(State4{0, 0, 0, 10}, 0.2, 0.0, 0.1);
  EXPECT_GT(a.psi, 0.0);
  EXPECT_EQ(a.psi, -b.psi);
}

TEST(KinematicBicycle, ConstantSteeringDrivesACircle) {
  const KinematicBicycle model{.length = 2.67};
  const double steer = 0.05;
  const double radius = 2.67 / steer;
  State4 state{0, 0, 0, 10};
  const int steps = static_cast<int>(kTwoPi * radius / 10.0 / 0.001 + 0.5);
  double farthest = 0.0;
  for (int i = 0; i < steps; ++i) {
    state = model.step(state, steer, 0.0, 0.001);
    farthest = std::max(farthest, std::fabs(std::hypot(state.x, state.y - radius) - radius));
  }
  EXPECT_LT(farthest, 0.04);  // Euler leaves the circle by v dt / 2 · 2π each turn
  EXPECT_NEAR(state.psi, kTwoPi, 1e-3);
}

TEST(KinematicBicycle, DualJacobianEqualsCentralDifferences) {
  Random random{3};
  const KinematicBicycle model{.length = 2.67, .steering_sign = -1.0};
  const auto step = [&](const auto& p) {
    using T = std::decay_t<decltype(p[0])>;
    const auto next = model.step(KinematicBicycle::StateOf<T>{p[0], p[1], p[2], p[3]}, p[4], p[5], 0.1);
    return std::array<T, 4>{next.x, next.y, next.psi, next.v};
  };
  for (int trial = 0; trial < 100; ++trial) {
    const std::array<double, 6> point{random.uniform(-10, 10),   random.uniform(-10, 10),
                                      random.uniform(-3, 3),     random.uniform(0, 50),
                                      random.uniform(-0.4, 0.4), random.uniform(-9, 5)};
    std::array<Dual<6>, 6> dual;
    for (std::size_t i = 0; i < 6; ++i) dual[i] = Dual<6>::variable(point[i], static_cast<int>(i));
    const auto exact = step(dual);
    for (std::size_t i = 0; i < 6; ++i) {
      constexpr double kStep = 1e-5;
      std::array<double, 6> above = point, below = point;
      above[i] += kStep;
      below[i] -= kStep;
      const auto f = step(above);
      const auto g = step(below);
      for (std::size_t row = 0; row < 4; ++row) {
        // kStep² · v dt / 6 plus rounding 1e-15 / kStep
        EXPECT_NEAR(exact[row].d[i], (f[row] - g[row]) / (2.0 * kStep), 1e-8);
      }
    }
  }
}

}  // namespace
}  // namespace chicane::model
