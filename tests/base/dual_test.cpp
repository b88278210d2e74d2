// SPDX-License-Identifier: MIT
#include "chicane/base/dual.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "chicane/base/random.hpp"

namespace chicane {
namespace {

/// A function that uses every operation once, kept away from the poles of tan, log, sqrt and the division.
template <class T>
T everything(const T& x, const T& y) {
  T sum = sin(x) * cos(y) + tan(0.3 * x) - atan(x * y) / (2.0 + x * x);
  sum += exp(0.2 * x - y) * log(3.0 + x * x) + sqrt(1.0 + y * y) + tanh(x - 2.0 * y);
  sum -= atan2(2.0 + y * y, 1.0 + x) * abs(x) + (x / 3.0 + 1.0) / (y * y + 1.0);
  sum *= 1.0 - 0.1 * x;
  sum /= T(2.0) + cos(x);
  return -sum + (5.0 - y) * 0.25;
}

TEST(Dual, ValueIsThatOfThePlainNumber) {
  Random random{1};
  for (int i = 0; i < 100; ++i) {
    const double x = random.uniform(-2.0, 2.0);
    const double y = random.uniform(-2.0, 2.0);
    EXPECT_NEAR(everything(Dual<2>::variable(x, 0), Dual<2>::variable(y, 1)).v, everything(x, y), 1e-13);
  }
}

TEST(Dual, FirstDerivativesEqualCentralDifferences) {
  Random random{2};
  constexpr double h = 1e-6;
  for (int i = 0; i < 200; ++i) {
    const double x = random.uniform(0.1, 2.0);  // |x| has a kink at 0
    const double y = random.uniform(-2.0, 2.0);
    const Dual<2> f = everything(Dual<2>::variable(x, 0), Dual<2>::variable(y, 1));
    // Truncation h² f''' and rounding 1e-16 / h are both near 1e-10; derivatives reach 1e2.
    EXPECT_NEAR(f.d[0], (everything(x + h, y) - everything(x - h, y)) / (2.0 * h), 1e-7);
    EXPECT_NEAR(f.d[1], (everything(x, y + h) - everything(x, y - h)) / (2.0 * h), 1e-7);
  }
}

TEST(Dual, NestedDualsGiveExactSecondDerivatives) {
  using Twice = Dual<2, Dual<2>>;
  Random random{3};
  constexpr double h = 1e-6;
  const auto gradient = [](double x, double y) {
    return everything(Dual<2>::variable(x, 0), Dual<2>::variable(y, 1)).d;
  };
  for (int i = 0; i < 200; ++i) {
    const double x = random.uniform(0.1, 2.0);
    const double y = random.uniform(-2.0, 2.0);
    const Twice f =
        everything(Twice::variable(Dual<2>::variable(x, 0), 0), Twice::variable(Dual<2>::variable(y, 1), 1));
    for (std::size_t j = 0; j < 2; ++j) {
      EXPECT_NEAR(f.d[0].d[j], (gradient(x + h, y)[j] - gradient(x - h, y)[j]) / (2.0 * h), 1e-6);
      EXPECT_NEAR(f.d[1].d[j], (gradient(x, y + h)[j] - gradient(x, y - h)[j]) / (2.0 * h), 1e-6);
    }
    EXPECT_DOUBLE_EQ(f.d[0].d[1], f.d[1].d[0]);
    EXPECT_EQ(value_of(f), f.v.v);
  }
}

TEST(Dual, ComparesByValueAlone) {
  const Dual<1> small = Dual<1>::variable(1.0, 0);
  const Dual<1> large(2.0);
  EXPECT_TRUE(small < large);
  EXPECT_TRUE(large > small);
  EXPECT_TRUE(small <= Dual<1>(1.0));
  EXPECT_TRUE(small >= 1.0);
  EXPECT_FALSE(small > large);
}

TEST(Dual, ABranchIsDifferentiatedOnTheSideItTakes) {
  EXPECT_EQ(abs(Dual<1>::variable(-3.0, 0)).d[0], -1.0);
  EXPECT_EQ(abs(Dual<1>::variable(3.0, 0)).d[0], 1.0);
}

TEST(Dual, NotANumberStaysOne) {
  const Dual<1> bad = log(Dual<1>::variable(-1.0, 0));
  EXPECT_TRUE(std::isnan(bad.v));
  EXPECT_TRUE(std::isnan((bad + 1.0).v));
}

}  // namespace
}  // namespace chicane
