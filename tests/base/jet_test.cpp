// SPDX-License-Identifier: MIT
#include "chicane/base/jet.hpp"

#include "chicane/base/random.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

/// First and second derivatives of a jet of any type as plain matrices.
template <int N>
struct Derivatives {
  double value;
  double first[N] = {};
  double second[N][N] = {};
  explicit Derivatives(const AnyJet auto& x) : value{x.v} {
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

/// Those of all_functions().
auto derivatives_at(const std::array<double, 3>& x) {
  const auto jets = all_functions(seed<2, 0>(x[0]), seed<2, 1>(x[1]), seed<2, 2>(x[2]));
  return std::apply([](const auto&... each) { return std::array{Derivatives<3>(each)...}; }, jets);
}

TEST(Jet, HasTheDerivativesOfDifferences) {
  constexpr double kStep = 1e-5;
  Random random{3};
  for (int turn = 0; turn < 200; ++turn) {
    const std::array<double, 3> x{random.uniform(-1.0, 1.0), random.uniform(0.2, 2.0),
                                  random.uniform(-1.0, 1.0)};
    const auto here = derivatives_at(x);
    const auto plain =
        std::apply([](auto... each) { return std::array{double{each}...}; }, all_functions(x[0], x[1], x[2]));
    for (std::size_t n = 0; n < here.size(); ++n)
      EXPECT_NEAR(here[n].value, plain[n], 1e-14 * (1.0 + std::fabs(plain[n]))) << n;
    // Near a kink differences see both sides.
    if (std::min({std::fabs(x[0]), std::fabs(x[0] - 0.1), std::fabs(x[0] - x[1] * x[2])}) < 1e-3) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      std::array<double, 3> moved = x;
      moved[i] += kStep;
      const auto up = derivatives_at(moved);
      moved[i] -= 2.0 * kStep;
      const auto down = derivatives_at(moved);
      for (std::size_t n = 0; n < here.size(); ++n) {
        const double slope = (up[n].value - down[n].value) / (2.0 * kStep);
        EXPECT_NEAR(here[n].first[i], slope, 1e-6 * (1.0 + std::fabs(slope))) << n << ' ' << i;
        for (std::size_t j = 0; j < 3; ++j) {
          const double bent = (up[n].first[j] - down[n].first[j]) / (2.0 * kStep);
          EXPECT_NEAR(here[n].second[i][j], bent, 1e-6 * (1.0 + std::fabs(bent)))
              << n << ' ' << i << ' ' << j;
        }
      }
    }
  }
}

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
