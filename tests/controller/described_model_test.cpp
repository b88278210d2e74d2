// SPDX-License-Identifier: MIT
#include "chicane/controller/described_model.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <tuple>

#include "chicane/base/math.hpp"
#include "chicane/controller/local_fit.hpp"

namespace chicane::controller {
namespace {

constexpr double kRounding = 1e-14;  // of a few operations on numbers of magnitude 10
const Cubic kLine{{0.5, 0.1, -0.02, 0.001}};
const std::array<double, 7> kState{2.0, 0.3, 0.05, 12.0, -0.04, 0.0, 0.0};

DescribedModel<Cubic> model(double sign = 1.0) {
  return {.line = kLine, .dt = 0.1, .turn_per_length = sign * 0.1 / 2.67};
}

TEST(DescribedModel, MovesByForwardEuler) {
  const std::array input{0.2, -0.5};
  const auto [x, y, psi, v, epsi, steer, acceleration] = model().next(kState, input, input);
  const double turn = 12.0 * 0.2 * 0.1 / 2.67;
  const double slope = 0.1 + 2.0 * (-0.02) * 2.0 + 3.0 * 0.001 * 4.0;
  EXPECT_NEAR(x, 2.0 + 1.2 * std::cos(0.05), kRounding);
  EXPECT_NEAR(y, 0.3 + 1.2 * std::sin(0.05), kRounding);
  EXPECT_NEAR(psi, 0.05 + turn, kRounding);
  EXPECT_NEAR(v, 12.0 - 0.05, kRounding);
  EXPECT_NEAR(epsi, 0.05 - std::atan(slope) + turn, kRounding);
  EXPECT_EQ(steer, 0.2);
  EXPECT_EQ(acceleration, -0.5);
}

TEST(DescribedModel, IsMovedByWhatActsAndKeepsWhatIsAsked) {
  const auto [x, y, psi, v, epsi, steer, acceleration] =
      model().next(kState, std::array{0.0, 1.0}, std::array{0.2, -0.5});
  EXPECT_EQ(psi, 0.05);
  EXPECT_NEAR(v, 12.1, kRounding);
  EXPECT_EQ(steer, 0.2);
  EXPECT_EQ(acceleration, -0.5);
}

TEST(DescribedModel, TurnsTheOtherWayWithTheOtherSign) {
  const std::array input{0.2, 0.0};
  const double left = std::get<2>(model(1.0).next(kState, input, input)) - 0.05;
  const double right = std::get<2>(model(-1.0).next(kState, input, input)) - 0.05;
  EXPECT_GT(left, 0.0);
  EXPECT_NEAR(right, -left, kRounding);
}

TEST(DescribedModel, NextLateralErrorIsOfTheLineBesideTheCar) {
  const double line = 0.5 + 0.1 * 2.0 - 0.02 * 4.0 + 0.001 * 8.0;
  EXPECT_NEAR(model().next_lateral_error(kState), line - 0.3 + 12.0 * std::sin(-0.04) * 0.1, kRounding);
}

TEST(DescribedModel, WithTheErrorToTheLeftACarThatHeadsForTheLineGetsNearer) {
  // Write-up 1: cte = y − f(x), cte⁺ = cte + v sin eψ dt; here with the other sign of the whole.
  const double line = 0.5 + 0.1 * 2.0 - 0.02 * 4.0 + 0.001 * 8.0;
  DescribedModel<Cubic> theirs = model();
  theirs.error_sign = -1.0;
  EXPECT_NEAR(-theirs.next_lateral_error(kState), 0.3 - line + 12.0 * std::sin(-0.04) * 0.1, kRounding);
  std::array<double, 7> right_of_it = kState;
  right_of_it[4] = 0.04;  // heads to the left, where the line is
  EXPECT_LT(std::fabs(theirs.next_lateral_error(right_of_it)), line - 0.3);
  EXPECT_GT(std::fabs(model().next_lateral_error(right_of_it)), line - 0.3);
}

TEST(DescribedModel, AnIntegratedHeadingErrorIsTheOneBeforePlusTheTurn) {
  // Write-up 1: eψ⁺ = eψ + v δ dt / L_f, from ψ = 0 and eψ = −arctan f′(0) on, whatever the line does.
  DescribedModel<Cubic> theirs = model();
  theirs.heading_reach = 0.0;
  std::array<double, 7> state{0.0, 0.0, 0.0, 12.0, -std::atan(theirs.line.slope(0.0)), 0.0, 0.0};
  double expected = state[4];
  for (const double steer : {0.2, 0.1, -0.3, 0.0}) {
    expected += state[3] * steer * theirs.turn_per_length;
    const std::array input{steer, 0.5};
    state = std::apply([](auto... value) { return std::array<double, 7>{value...}; },
                       theirs.next(state, input, input));
    EXPECT_NEAR(state[4], expected, kRounding);
  }
  EXPECT_GT(std::fabs(model().line.slope(state[0]) - model().line.slope(0.0)), 0.01) << "the line does bend";
}

TEST(DescribedModel, ARecursiveLateralErrorIsTheOneBeforePlusItsStep) {
  // Write-up 1: cte = y − f(x) at the beginning, then cte⁺ = cte + v sin eψ dt, whatever the line does.
  const double slope = kLine.slope(0.0);
  DescribedModel<Cubic> theirs = model();
  theirs.error_sign = -1.0;
  theirs.heading_reach = theirs.lateral_reach = 0.0;
  theirs.lateral_by_x = slope / std::hypot(1.0, slope);
  theirs.lateral_by_y = -1.0 / std::hypot(1.0, slope);
  std::array<double, 7> state{0.0, 0.0, 0.0, 12.0, -std::atan(slope), 0.0, 0.0};
  double expected = -kLine.at(0.0);
  for (const double steer : {0.2, 0.1, -0.3, 0.0}) {
    expected += state[3] * std::sin(state[4]) * theirs.dt;
    EXPECT_NEAR(-theirs.next_lateral_error(state), expected, kRounding);
    const std::array input{steer, 0.5};
    state = std::apply([](auto... value) { return std::array<double, 7>{value...}; },
                       theirs.next(state, input, input));
  }
  EXPECT_GT(std::fabs(theirs.next_lateral_error(state) - model().next_lateral_error(state)), 0.1)
      << "the line bends away from its tangent";
}

}  // namespace
}  // namespace chicane::controller
