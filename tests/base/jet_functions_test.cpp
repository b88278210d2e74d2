// SPDX-License-Identifier: MIT
#include "chicane/base/jet.hpp"

#include "chicane/base/pack.hpp"
#include "chicane/base/random.hpp"
#include "support/chicane_test.hpp"

namespace models {  // as users write them: nothing of chicane is in scope

/// Every function of two variables, a in (-0.9, 0.9) and b in (0.2, 2): called by name alone.
template <class A, class B>
auto all_functions(const A& a, const B& b) {
  return std::make_tuple(a + b, a - b, a * b, a / b, -a, 2.0 + a, a - 3.0, 3.0 - a, 2.0 * a, a / 3.0, 3.0 / b,
                         (a + b) * (b - a), sin(a) * cos(b) / sqrt(b * b + a * a + 1.0) + exp(-a * a), sin(a),
                         cos(a), tan(a), asin(a), acos(a), atan(a), sqrt(b), exp(a), log(b), tanh(a),
                         atan2(a, b), atan2(a, 0.5), atan2(0.5, b), hypot(a, b), hypot(a, 0.7), hypot(1, b),
                         pow(a, 0), pow(a, 1), pow(a, 2), pow(a, 3), pow(b, -2), pow(b, 0.5), pow(b, 1.7),
                         pow(b, a), pow(2.0, a), abs(a), max(a, 0.1), min(a, b), positive_part(a),
                         select(a > 0.2, a * b, b), select((a > 0.0) & (b > 1.0), a, 0.3), smooth_abs(a, 0.1),
                         smooth_positive_part(a, 0.1), smooth_max(a, b, 0.2), smooth_max(a, 0.3, 0.2),
                         smooth_min(a, b, 0.2), smooth_min(a, 0, 0.2), smooth_step(a, 0.3),
                         asin(0.5 * a) * pow(hypot(a, b), 1.5) - acos(a * 0.3) / pow(b, 3));
}

}  // namespace models

namespace chicane {
namespace {

using First = Jet<double, 2, variable(0), variable(0)>;
using Second = Jet<double, 2, variable(1), variable(1)>;

/// Value, two slopes, and the second derivatives aa, ab, bb of every function at (a, b).
constexpr std::size_t kFunctions = std::tuple_size_v<decltype(models::all_functions(First{}, Second{}))>;
using Numbers = std::array<std::array<double, 6>, kFunctions>;

Numbers at(double a, double b) {
  Numbers result;
  const auto all = models::all_functions(seed<2, 0>(a), seed<2, 1>(b));
  jet::repeat<static_cast<int>(kFunctions)>([&](auto n) {
    const auto& x = std::get<n>(all);
    result[n] = {x.v,
                 jet::number<double>(jet::slope<0>(x)),
                 jet::number<double>(jet::slope<1>(x)),
                 jet::number<double>(jet::curvature<0, 0>(x)),
                 jet::number<double>(jet::curvature<0, 1>(x)),
                 jet::number<double>(jet::curvature<1, 1>(x))};
  });
  return result;
}

TEST(JetFunctions, HaveTheDerivativesThatDifferencesShow) {
  constexpr double h = 1e-5;
  Random random{11};
  for (int turn = 0; turn < 200; ++turn) {
    const double a = random.uniform(-0.9, 0.9), b = random.uniform(0.2, 2.0);
    // Differences across an edge say nothing.
    if (std::fabs(a) < 0.01 || std::fabs(a - 0.1) < 0.01 || std::fabs(a - 0.2) < 0.01 ||
        std::fabs(a - b) < 0.01 || std::fabs(b - 1.0) < 0.01)
      continue;
    const Numbers here = at(a, b);
    const auto plain = std::make_tuple(
        a + b, a - b, a * b, a / b, -a, 2.0 + a, a - 3.0, 3.0 - a, 2.0 * a, a / 3.0, 3.0 / b,
        (a + b) * (b - a), sin(a) * cos(b) / std::sqrt(b * b + a * a + 1.0) + exp(-a * a), sin(a), cos(a),
        tan(a), asin(a), acos(a), atan(a), std::sqrt(b), exp(a), log(b), tanh(a), atan2(a, b));
    const auto expect_value = [&](std::size_t n, double x) {
      EXPECT_NEAR(here[n][0], x, 1e-14 * (1.0 + std::fabs(x))) << n;
    };
    std::apply([&, n = std::size_t{0}](auto... x) mutable { (expect_value(n++, x), ...); }, plain);
    const Numbers left = at(a - h, b), right = at(a + h, b), below = at(a, b - h), above = at(a, b + h);
    for (std::size_t n = 0; n < kFunctions; ++n) {
      // Differences of double precision: h² · third derivative (1e4 at asin's ends) and rounding / h.
      const auto expect = [&](double exact, double low, double high) {
        EXPECT_NEAR(exact, (high - low) / (2.0 * h), 1e-6 * (1.0 + std::fabs(exact)))
            << n << ' ' << a << ' ' << b;
      };
      expect(here[n][1], left[n][0], right[n][0]);
      expect(here[n][2], below[n][0], above[n][0]);
      expect(here[n][3], left[n][1], right[n][1]);
      expect(here[n][4], below[n][1], above[n][1]);
      expect(here[n][5], below[n][2], above[n][2]);
    }
  }
}

/// Every function of two variables of one type.
template <class J>
auto all_of(const J& a, const J& b) {
  return std::apply([](const auto&... x) { return std::array<J, sizeof...(x)>{x...}; },
                    models::all_functions(a, b));
}

TEST(JetFunctions, HaveTheSameBitsWithLoosePatterns) {
  using Loose = LooseJet<double, 2>;
  using Dense = Jet<double, 2, 3, 0, Pairs::of(3, 3)>;
  static_assert(std::is_same_v<Common<double, Loose, Loose>, Loose>);
  Random random{14};
  for (int turn = 0; turn < 100; ++turn) {
    const double a = random.uniform(-0.9, 0.9), b = random.uniform(0.2, 2.0);
    Dense dense_a(a), dense_b(b);
    dense_a.slopes[0] = dense_b.slopes[1] = 1.0;
    const auto expected = all_of(dense_a, dense_b);
    const auto found = all_of(Loose::variable(a, 0), Loose::variable(b, 1));
    for (std::size_t n = 0; n < kFunctions; ++n) {
      std::array<double, 2> slopes{};
      std::array<double, 3> curvatures{};
      found[n].each_slope([&](std::size_t i, double slope) { slopes[i] = slope; });
      found[n].each_curvature([&](std::size_t i, std::size_t j, double curvature) {
        curvatures[j * (j + 1) / 2 + i] = curvature;
      });
      EXPECT_EQ(found[n].v, expected[n].v) << n;
      EXPECT_EQ(slopes, expected[n].slopes) << n;
      EXPECT_EQ(found[n].slopes, expected[n].slopes) << n;
      EXPECT_EQ(curvatures, expected[n].curvatures) << n;
    }
  }
}

TEST(JetFunctions, KnowLoosePatterns) {
  using Loose = LooseJet<double, 4>;
  const Loose a = Loose::variable(0.3, 0), b = Loose::variable(0.5, 1), d = Loose::variable(0.7, 3);
  const auto expect = [](const Loose& x, Variables first, Variables second) {
    EXPECT_EQ(x.first, first);
    EXPECT_EQ(x.second, second);
  };
  expect(Loose(2.0), 0, 0);
  expect(2.0 * a - d + 1.0, 9, 0);
  expect(sin(a) - d, 9, 1);
  expect(a * b + d, 11, 3);
  expect(select(true, a, b * b), 3, 2);
  Loose copy = a * b;
  copy = d;
  expect(copy, 8, 0);
}

TEST(JetFunctions, AgreeWithTheStandardLibrary) {
  Random random{12};
  for (int turn = 0; turn < 1000; ++turn) {
    const double x = random.uniform(-1.0, 1.0), y = random.uniform(0.01, 50.0), p = random.uniform(-5.0, 5.0);
    EXPECT_NEAR(asin(x), std::asin(x), 1e-15);  // a few ulp
    EXPECT_NEAR(acos(x), std::acos(x), 2e-15);
    EXPECT_NEAR(pow(y, p), std::pow(y, p), 1e-14 * std::pow(y, p));  // 20 ulp: |p log y| < 20
    for (const double whole : {-3.0, 0.0, 1.0, 2.0, 7.0})
      EXPECT_NEAR(pow(x, whole), std::pow(x, whole), 1e-14 * std::fabs(std::pow(x, whole)));
  }
}

TEST(JetFunctions, AreDefinedAtEdges) {
  EXPECT_DOUBLE_EQ(asin(1.0), std::asin(1.0));
  EXPECT_DOUBLE_EQ(acos(-1.0), std::acos(-1.0));
  EXPECT_TRUE(std::isnan(asin(1.1)) && std::isnan(acos(-1.1)));
  EXPECT_EQ(pow(0.0, 0.0), 1.0);
  EXPECT_EQ(pow(0.0, 2.5), 0.0);
  EXPECT_EQ(pow(-2.0, 3.0), -8.0);
  EXPECT_TRUE(std::isnan(pow(-2.0, 0.5)));
  const auto zero = seed<2, 0>(0.0);
  for (const double exponent : {0.0, 1.0, 2.0, 3.0}) {
    const auto x = pow(zero, exponent);
    EXPECT_EQ(x.v, exponent == 0.0 ? 1.0 : 0.0);
    EXPECT_EQ((jet::number<double>(jet::slope<0>(x))), exponent == 1.0 ? 1.0 : 0.0);
    EXPECT_EQ((jet::number<double>(jet::curvature<0, 0>(x))), exponent == 2.0 ? 2.0 : 0.0);
  }
  EXPECT_FALSE(std::isfinite(jet::number<double>(jet::slope<0>(asin(seed<2, 0>(1.0))))));
  EXPECT_TRUE(std::isnan(jet::number<double>(jet::slope<0>(hypot(zero, 0.0)))));
  // Sharp ones have the side of the second argument, abs that of +x, positive_part that of 0.
  EXPECT_EQ((jet::number<double>(jet::slope<0>(max(zero, 2.0 * zero)))), 2.0);
  EXPECT_EQ((jet::number<double>(jet::slope<0>(min(zero, 2.0 * zero)))), 2.0);
  EXPECT_EQ((jet::number<double>(jet::slope<0>(abs(zero)))), 1.0);
  EXPECT_EQ((jet::number<double>(jet::slope<0>(positive_part(zero)))), 0.0);
  EXPECT_DOUBLE_EQ(smooth_abs(0.0, 0.1), 0.1);
  EXPECT_DOUBLE_EQ(smooth_positive_part(0.0, 0.1), 0.05);
  EXPECT_DOUBLE_EQ(smooth_step(0.0, 0.1), 0.5);
}

TEST(JetFunctions, GivePacksTheBitsOfNumbers) {
  using P = Pack<arch::Baseline, 4>;
  Random random{13};
  for (int turn = 0; turn < 100; ++turn) {
    P x, y;
    for (std::size_t lane = 0; lane < 4; ++lane) {
      x.set(lane, random.uniform(-0.9, 0.9));
      y.set(lane, random.uniform(0.2, 2.0));
    }
    const auto packs =
        std::make_tuple(asin(x), acos(x), pow(x, 3), pow(y, 1.7), pow(y, x), hypot(x, 1.0), atan2(x, 0.5));
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const double a = x[lane], b = y[lane];
      const std::array<double, 7> numbers{asin(a),         acos(a),       pow(a, 3),    pow(b, 1.7),
                                          exp(a * log(b)), hypot(a, 1.0), atan2(a, 0.5)};
      jet::repeat<7>([&](auto n) { EXPECT_EQ(std::get<n>(packs)[lane], numbers[n]) << n; });
    }
  }
}

}  // namespace
}  // namespace chicane
