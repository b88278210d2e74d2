// SPDX-License-Identifier: MIT
#include "chicane/base/jet.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "chicane/base/dual.hpp"
#include "chicane/base/random.hpp"

namespace chicane {
namespace {

/// First and second derivatives of a jet of any type as plain matrices.
template <int N, class J>
struct Derivatives {
  double first[N] = {};
  double second[N][N] = {};
  explicit Derivatives(const J& x) {
    jet::repeat<N>([&](auto i) {
      first[i] = jet::number<double>(jet::slope<i>(x));
      jet::repeat<N>([&](auto j) { second[i][j] = jet::number<double>(jet::curvature<i, j>(x)); });
    });
  }
};

/// Every function that jets know, at once and one by one, over any scalar.
template <class A, class B, class C>
auto all_functions(const A& a, const B& b, const C& c) {
  return std::make_tuple(
      a + b, a - b, b - c, a * b, a / b, -a, 2.0 + a, a - 3.0, 3.0 - a, 2.0 * a, a / 3.0, 3.0 / b, a * a,
      (a + b) * (b - c), sin(a), cos(a * b), tan(a), atan(a * c), sqrt(b), exp(a), log(b), tanh(a + c),
      atan2(a, b), select(a > 0.1, a * b, c), max(a, b * c), min(a, b * c), positive_part(a), abs(a),
      sin(a) * cos(b) / sqrt(b * b + c * c + 1.0) + exp(-a * a) * atan2(b, 2.0 + c), a * (b * c) - a * b * c);
}

TEST(Jet, HasTheDerivativesOfNestedDuals) {
  using D = Dual<3>;
  using D2 = Dual<3, D>;
  Random random{3};
  for (int turn = 0; turn < 200; ++turn) {
    const double a = random.uniform(-1.0, 1.0), b = random.uniform(0.2, 2.0), c = random.uniform(-1.0, 1.0);
    const auto jets = all_functions(seed<2, 0>(a), seed<2, 1>(b), seed<2, 2>(c));
    const auto duals = all_functions(D2::variable(D::variable(a, 0), 0), D2::variable(D::variable(b, 1), 1),
                                     D2::variable(D::variable(c, 2), 2));
    constexpr int count = std::tuple_size_v<decltype(jets)>;
    jet::repeat<count>([&](auto n) {
      const auto& x = std::get<n>(jets);
      const auto& y = std::get<n>(duals);
      const Derivatives<3, std::remove_cvref_t<decltype(x)>> d{x};
      EXPECT_NEAR(x.v, value_of(y), 1e-14 * (1.0 + std::fabs(x.v))) << n;
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(d.first[i], y.d[i].v, 1e-12 * (1.0 + std::fabs(d.first[i]))) << n << ' ' << i;
        for (std::size_t j = 0; j < 3; ++j)
          EXPECT_NEAR(d.second[i][j], y.d[i].d[j], 1e-11 * (1.0 + std::fabs(d.second[i][j])))
              << n << ' ' << i << ' ' << j;
      }
    });
  }
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
  const Derivatives<4, T> wide{b};
  const auto narrow = sin(x * y) * x + 2.0;
  const Derivatives<4, std::remove_const_t<decltype(narrow)>> tight{narrow};
  for (int i = 0; i < 4; ++i) {
    EXPECT_DOUBLE_EQ(wide.first[i], tight.first[i]);
    for (int j = 0; j < 4; ++j) EXPECT_DOUBLE_EQ(wide.second[i][j], tight.second[i][j]);
  }
}

}  // namespace
}  // namespace chicane
