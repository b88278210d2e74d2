// SPDX-License-Identifier: MIT
#include "chicane/controller/cubic_problem.hpp"

#include "chicane/base/math.hpp"
#include "support/chicane_test.hpp"

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
  // Write-up of `measured-latency`: cte = y − f(x), cte⁺ = cte + v sin eψ dt; here with the other sign of the
  // whole.
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
  // Write-up of `measured-latency`: eψ⁺ = eψ + v δ dt / L_f, from ψ = 0 and eψ = −arctan f′(0) on, whatever
  // the line does.
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
  // Write-up of `measured-latency`: cte = y − f(x) at the beginning, then cte⁺ = cte + v sin eψ dt, whatever
  // the line does.
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

constexpr double kLength = 2.67;

/// Heading along W's y at 20 m/s, wheel 0.1 rad to the left, half throttle.
model::Measurement moving() {
  model::Measurement now;
  now.x = 3.0;
  now.y = 4.0;
  now.psi = 0.5 * kPi;
  now.speed = 20.0;
  now.steer = 0.1;
  now.throttle = 0.5;
  now.delay = 0.14;
  return now;
}

Motion predict(LatencyHandling handling, const model::Measurement& now) {
  RollForward roll{handling, 0.1, kLength};
  return roll.predict(now);
}

TEST(RollForward, LeavesTheMeasurementAloneWithoutCompensationAndInsideTheModel) {
  for (const auto handling : {LatencyHandling::kNone, LatencyHandling::kInsideModel}) {
    RollForward roll{handling, 0.1, kLength};
    const Motion start = roll.predict(moving());
    EXPECT_EQ(start.pose.x, 3.0);
    EXPECT_EQ(start.pose.y, 4.0);
    EXPECT_EQ(start.pose.psi, 0.5 * kPi);
    EXPECT_EQ(start.speed, 20.0);
    EXPECT_EQ(roll.compensated(), 0.0);
  }
}

TEST(RollForward, MovesOnlyThePositionWhenAskedTo) {
  const Motion start = predict(LatencyHandling::kPositionOnly, moving());
  EXPECT_NEAR(start.pose.x, 3.0, 1e-12);
  EXPECT_NEAR(start.pose.y, 6.0, 1e-12);
  EXPECT_EQ(start.pose.psi, 0.5 * kPi);
  EXPECT_EQ(start.speed, 20.0);
}

TEST(RollForward, MovesTheWholeKinematicState) {
  const Motion start = predict(LatencyHandling::kRollForward, moving());
  EXPECT_NEAR(start.pose.y, 6.0, 1e-12);
  EXPECT_NEAR(start.pose.psi, 0.5 * kPi + 20.0 * 0.1 / kLength * 0.1, 1e-12);
  EXPECT_NEAR(start.speed, 20.05, 1e-12);
}

TEST(RollForward, AveragesTheMeasuredLatencyWithTheValueBefore) {
  RollForward roll{LatencyHandling::kMeasured, 0.1, kLength};
  const Motion start = roll.predict(moving());
  const double latency = 0.5 * (0.1 + 0.14);
  EXPECT_DOUBLE_EQ(roll.compensated(), latency);
  const double curvature = std::tan(0.1) / kLength;
  EXPECT_NEAR(start.pose.y, 4.0 + 20.0 * latency, 1e-12);
  EXPECT_NEAR(start.pose.psi,
              0.5 * kPi + 20.0 * curvature * latency + 0.5 * 0.5 * curvature * latency * latency, 1e-12);
  EXPECT_NEAR(start.speed, 20.0 + 0.5 * latency, 1e-12);
  (void)roll.predict(moving());
  EXPECT_DOUBLE_EQ(roll.compensated(), 0.5 * (latency + 0.14));
  roll.reset();
  EXPECT_DOUBLE_EQ(roll.compensated(), 0.1);
}

TEST(RollForward, LeavesOutTheTermOfTheAccelerationWhenAskedTo) {
  RollForward with{LatencyHandling::kMeasured, 0.1, kLength};
  RollForward without{LatencyHandling::kMeasured, 0.1, kLength, 1.0, false};
  const double latency = 0.5 * (0.1 + 0.14);
  const double term = 0.5 * 0.5 * std::tan(0.1) / kLength * latency * latency;
  EXPECT_NEAR(with.predict(moving()).pose.psi - without.predict(moving()).pose.psi, term, 1e-14);
  EXPECT_GT(term, 1e-4);
}

TEST(RollForward, RejectsAnImpossibleLatency) {
  RollForward roll{LatencyHandling::kMeasured, 0.1, kLength};
  model::Measurement now = moving();
  for (const double delay :
       {std::numeric_limits<double>::quiet_NaN(), 1e9, -1e9, std::numeric_limits<double>::infinity()}) {
    now.delay = delay;
    (void)roll.predict(now);
    EXPECT_GE(roll.compensated(), 0.0);
    EXPECT_LE(roll.compensated(), 0.5);
  }
}

TEST(RollForward, MirrorsWithTheWheel) {
  model::Measurement left = moving();
  left.psi = 0.0;
  model::Measurement right = left;
  right.steer = -left.steer;
  for (const auto handling : {LatencyHandling::kRollForward, LatencyHandling::kMeasured}) {
    EXPECT_EQ(predict(handling, left).pose.psi, -predict(handling, right).pose.psi);
  }
}

TEST(RollForward, MilesPerHourTakeTheCarAsMuchFarther) {
  model::Measurement now;
  now.speed = 10.0;
  now.psi = 0.3;
  now.steer = 0.05;
  RollForward literal(LatencyHandling::kPositionOnly, 0.1, 2.67, 2.25);
  RollForward longer(LatencyHandling::kPositionOnly, 0.225, 2.67);
  const Motion a = literal.predict(now);
  const Motion b = longer.predict(now);
  EXPECT_NEAR(a.pose.x, b.pose.x, 1e-12);
  EXPECT_NEAR(a.pose.y, b.pose.y, 1e-12);
  EXPECT_NEAR(a.speed, 10.0, 1e-12);  // told in m/s again
  RollForward inside(LatencyHandling::kInsideModel, 0.1, 2.67, 2.25);
  EXPECT_EQ(inside.predict(now).speed, 10.0);
}

}  // namespace
}  // namespace chicane::controller
