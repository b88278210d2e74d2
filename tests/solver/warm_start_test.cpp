// SPDX-License-Identifier: MIT
#include "chicane/solver/warm_start.hpp"

#include "problems/described_problem.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

using bench::DescribedTrajectory;

DescribedTrajectory<8> counting(int horizon) {
  DescribedTrajectory<8> trajectory;
  trajectory.horizon = horizon;
  for (std::size_t k = 0; k <= static_cast<std::size_t>(horizon); ++k)
    trajectory.x[k][0] = static_cast<double>(k);
  for (std::size_t k = 0; k < static_cast<std::size_t>(horizon); ++k)
    trajectory.u[k][1] = static_cast<double>(k);
  return trajectory;
}

TEST(Shift, ByOneIntervalDropsTheFirstInputAndRepeatsTheLast) {
  auto t = counting(4);
  solver::shift(t, 1.0);
  EXPECT_EQ(t.u[0][1], 1.0);
  EXPECT_EQ(t.u[2][1], 3.0);
  EXPECT_EQ(t.u[3][1], 3.0);
  EXPECT_EQ(t.x[0][0], 1.0);
  EXPECT_EQ(t.x[4][0], 4.0);
}

TEST(Shift, ByAFractionBlendsNeighbours) {
  auto t = counting(4);
  solver::shift(t, 1.25);
  EXPECT_DOUBLE_EQ(t.u[0][1], 1.25);
  EXPECT_DOUBLE_EQ(t.u[1][1], 2.25);
  EXPECT_DOUBLE_EQ(t.u[2][1], 3.0);
  EXPECT_DOUBLE_EQ(t.x[2][0], 3.25);
}

TEST(Shift, BeyondTheHorizonRepeatsTheLastInput) {
  auto t = counting(4);
  solver::shift(t, 1e9);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(t.u[k][1], 3.0);
}

TEST(Shift, IgnoresTimesThatMakeNoSense) {
  using Limits = std::numeric_limits<double>;
  for (const double steps : {0.0, -1.0, Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
    auto t = counting(4);
    solver::shift(t, steps);
    EXPECT_EQ(t.u[1][1], 1.0);
  }
}

TEST(Resample, ToTheSameGridChangesNothing) {
  auto t = counting(4);
  solver::resample(t, 4, 1.0);
  EXPECT_EQ(t.horizon, 4);
  EXPECT_EQ(t.u, counting(4).u);
  EXPECT_EQ(t.x, counting(4).x);
}

TEST(Resample, KeepsTheMotionInTimeAndRepeatsItsEnd) {
  auto t = counting(4);
  solver::resample(t, 6, 0.5);  // intervals half as long
  EXPECT_EQ(t.horizon, 6);
  EXPECT_DOUBLE_EQ(t.u[1][1], 0.5);
  EXPECT_DOUBLE_EQ(t.u[4][1], 2.0);
  EXPECT_DOUBLE_EQ(t.x[6][0], 3.0);
  t = counting(4);
  solver::resample(t, 6, 1.0);
  EXPECT_DOUBLE_EQ(t.u[5][1], 3.0);
  EXPECT_DOUBLE_EQ(t.x[6][0], 4.0);
}

TEST(RollOut, ClampsTheInputsAndSimulatesThem) {
  bench::DescribedInstance instance;
  instance.place(10.0);
  DescribedTrajectory<8> t;
  t.horizon = 2;
  t.u[0] = {0.0, 99.0};
  t.u[1] = {std::numeric_limits<double>::quiet_NaN(), -99.0};
  EXPECT_TRUE(solver::roll_out(instance.problem, instance.start, t));
  EXPECT_EQ(t.u[0][1], 1.0);
  EXPECT_EQ(t.u[1][0], 0.0);
  EXPECT_DOUBLE_EQ(t.x[1][3], 10.1);
  EXPECT_DOUBLE_EQ(t.x[2][3], 10.0);
  EXPECT_DOUBLE_EQ(t.x[1][0], 1.0);
}

TEST(RollOut, ReportsStatesThatAreNotFinite) {
  bench::DescribedInstance instance;
  instance.place(std::numeric_limits<double>::infinity());
  DescribedTrajectory<8> t;
  t.horizon = 2;
  EXPECT_FALSE(solver::roll_out(instance.problem, instance.start, t));
}

}  // namespace
}  // namespace chicane
