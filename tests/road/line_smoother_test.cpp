// SPDX-License-Identifier: MIT
#include "chicane/road/line_planner.hpp"
#include "support/chicane_test.hpp"

namespace chicane::road {
namespace {

constexpr int kKnotCount = 80;
constexpr double kSpacing = 3.0;

/// Offsets for a line of the given curvatures.
std::vector<double> smooth(const std::vector<double>& curvature, double width, int share = 1'000'000) {
  LineSmoother smoother(kKnotCount);
  smoother.configure(width, 4.0);
  smoother.begin(kKnotCount, kSpacing, 0);
  std::copy(curvature.begin(), curvature.end(), smoother.curvature().begin());
  for (int work = share; !smoother.advance(work); work = share) {
  }
  std::vector<double> offsets;
  for (int k = 0; k < kKnotCount; ++k) offsets.push_back(smoother.offset(k));
  return offsets;
}

/// One bend to the left by 1.2 rad in the middle of a straight.
std::vector<double> bend() {
  std::vector<double> curvature(kKnotCount, 0.0);
  for (std::size_t k = 30; k < 50; ++k) curvature[k] = 0.02;
  return curvature;
}

double bending(const std::vector<double>& curvature, const std::vector<double>& n) {
  double sum = 0.0;
  for (std::size_t k = 1; k + 1 < n.size(); ++k) {
    const double kappa = curvature[k] * (1.0 + curvature[k] * n[k]) +
                         (n[k - 1] - 2.0 * n[k] + n[k + 1]) / (kSpacing * kSpacing);
    sum += kappa * kappa;
  }
  return sum;
}

TEST(LineSmoother, LeavesAStraightLineAndALineWithoutRoomWhereTheyAre) {
  for (const double n : smooth(std::vector<double>(kKnotCount, 0.0), 2.0)) EXPECT_EQ(n, 0.0);
  for (const double n : smooth(bend(), 0.0)) EXPECT_EQ(n, 0.0);
}

TEST(LineSmoother, CutsABendOnItsInsideAndBendsLess) {
  const std::vector<double> n = smooth(bend(), 1.5);
  EXPECT_GT(*std::max_element(n.begin() + 35, n.begin() + 45), 0.5) << "left is the inside";
  EXPECT_LT(std::min(n[25], n[54]), -0.3) << "and comes from the outside";
  EXPECT_LT(bending(bend(), n), 0.8 * bending(bend(), std::vector<double>(kKnotCount, 0.0)));
}

TEST(LineSmoother, KeepsWithinAboutItsWidth) {
  for (const double width : {0.5, 1.0, 2.0}) {
    // The weight is raised a few times over, and not until the bound holds.
    for (const double n : smooth(bend(), width)) EXPECT_LT(std::fabs(n), 1.3 * width) << width;
  }
}

TEST(LineSmoother, MirrorsLeftAndRightExactly) {
  std::vector<double> right = bend();
  for (double& kappa : right) kappa = -kappa;
  const std::vector<double> n = smooth(bend(), 1.5);
  const std::vector<double> mirrored = smooth(right, 1.5);
  for (std::size_t k = 0; k < n.size(); ++k) EXPECT_EQ(mirrored[k], -n[k]) << k;
}

TEST(LineSmoother, GivesTheSameBitsHoweverTheWorkIsShared) {
  EXPECT_EQ(smooth(bend(), 1.5, 7), smooth(bend(), 1.5));
}

TEST(LineSmoother, MovesAClosedLineAlikeWhereItMeetsItself) {
  constexpr int kPeriod = 84;  // knots 84 to 167, and a lap more at both ends
  constexpr int kAll = 3 * kPeriod;
  LineSmoother smoother(kAll);
  smoother.configure(1.0, 4.0);
  smoother.begin(kAll, kSpacing, kPeriod);
  for (int k = 0; k < kAll; ++k)
    smoother.curvature()[static_cast<std::size_t>(k)] = 0.03 * (k % 42 < 20 ? 1.0 : 0.2);
  for (int work = 1'000'000; !smoother.advance(work); work = 1'000'000) {
  }
  // Both places are 250 m from an end, where the line is held.
  for (int k = 82; k < 87; ++k) EXPECT_NEAR(smoother.offset(k), smoother.offset(k + kPeriod), 0.02) << k;
}

}  // namespace
}  // namespace chicane::road
