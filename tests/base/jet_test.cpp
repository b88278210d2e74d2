// SPDX-License-Identifier: MIT
#include "chicane/base/jet.hpp"

#include "support/chicane_test.hpp"

namespace chicane {
namespace {

/// First and second derivatives of a jet of any type as plain matrices.
template <int N>
struct Derivatives {
  double first[N] = {};
  double second[N][N] = {};
  explicit Derivatives(const AnyJet auto& x) {
    jet::repeat<N>([&](auto i) {
      first[i] = jet::number<double>(jet::slope<i>(x));
      jet::repeat<N>([&](auto j) { second[i][j] = jet::number<double>(jet::curvature<i, j>(x)); });
    });
  }
};

TEST(Jet, ComparesByValueAloneAndKeepsNotANumber) {
  const auto small = FullJet<1>::variable(1.0, 0);
  const FullJet<1> large(2.0);
  EXPECT_TRUE(small < large);
  EXPECT_TRUE(large > small);
  EXPECT_TRUE(small >= 1.0);
  EXPECT_FALSE(small > large);
  EXPECT_TRUE(std::isnan((log(FullJet<1>::variable(-1.0, 0)) + 1.0).v));
}

TEST(Jet, StoresOnlyWhatIsNotZeroByConstruction) {
  const auto x = seed<2, 0>(1.0);
  const auto y = seed<2, 1>(2.0);
  const auto z = seed<2, 2>(3.0);
  const auto f = x + y * z;
  using F = decltype(f);
  EXPECT_EQ(F::kFirst, 0b111U);
  EXPECT_EQ(F::kUnit, 0b001U);
  EXPECT_EQ(F::kSecond, Pairs::of(0b010, 0b100));
  EXPECT_EQ(sizeof(f), 4 * sizeof(double));
  EXPECT_EQ(decltype(x - y)::kUnit, 0b001U);
  EXPECT_EQ(decltype(x + x)::kUnit, 0U);
  EXPECT_EQ(decltype(sin(z))::kSecond, Pairs::of(0b100, 0b100));
  EXPECT_EQ((decltype(3.0 * x + 1.0)::kSecond), Pairs{});
}

TEST(Jet, WidensWithoutChangingAnything) {
  const auto x = seed<2, 0>(0.3);
  const auto y = seed<2, 3>(0.4);
  using T = Common<decltype(x), decltype(y), double>;
  const T a = x * y;
  const T b = sin(a) * x + 2.0;  // closed under arithmetic
  const Derivatives<4> wide{b};
  const auto narrow = sin(x * y) * x + 2.0;
  const Derivatives<4> tight{narrow};
  for (int i = 0; i < 4; ++i) {
    EXPECT_DOUBLE_EQ(wide.first[i], tight.first[i]);
    for (int j = 0; j < 4; ++j) EXPECT_DOUBLE_EQ(wide.second[i][j], tight.second[i][j]);
  }
}

}  // namespace
}  // namespace chicane
