// SPDX-License-Identifier: MIT
#include "chicane/base/math.hpp"

#include <bit>

#include "chicane/base/median.hpp"
#include "chicane/base/pack.hpp"
#include "chicane/base/random.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

double ulps(double got, long double want) {
  const double rounded = static_cast<double>(want);
  const double ulp = std::nextafter(std::fabs(rounded), 1e308) - std::fabs(rounded);
  return static_cast<double>(std::fabs((static_cast<long double>(got) - want)) /
                             static_cast<long double>(ulp));
}

/// Largest error in units of the last place over random arguments, against long double.
template <class F, class G>
double worst(F ours, G theirs, double low, double high) {
  Random random(7);
  double result = 0.0;
  for (int i = 0; i < 200000; ++i) {
    const double x = random.uniform(low, high);
    result = std::max(result, ulps(ours(x), theirs(static_cast<long double>(x))));
  }
  return result;
}

TEST(Math, IsWithinOneUlpOfLongDouble) {
  using L = long double;
  EXPECT_LT(worst([](double x) { return sin(x); }, [](L x) { return std::sin(x); }, -50.0, 50.0), 1.0);
  EXPECT_LT(worst([](double x) { return cos(x); }, [](L x) { return std::cos(x); }, -50.0, 50.0), 1.0);
  EXPECT_LT(worst([](double x) { return atan(x); }, [](L x) { return std::atan(x); }, -5.0, 5.0), 1.0);
  EXPECT_LT(worst([](double x) { return exp(x); }, [](L x) { return std::exp(x); }, -50.0, 50.0), 1.0);
  EXPECT_LT(worst([](double x) { return log(x); }, [](L x) { return std::log(x); }, 1e-6, 50.0), 1.0);
}

TEST(Math, SineAndCosineTogetherHaveTheSameBits) {
  for (double x = -30.0; x < 30.0; x += 0.0371) {
    const auto [sine, cosine] = sine_cosine(x);
    EXPECT_EQ(sine, sin(x)) << x;
    EXPECT_EQ(cosine, cos(x)) << x;
  }
}

TEST(Math, CompositesAreWithinFourUlp) {
  using L = long double;
  EXPECT_LT(worst([](double x) { return tan(x); }, [](L x) { return std::tan(x); }, -1.5, 1.5), 3.0);
  EXPECT_LT(worst([](double x) { return tanh(x); }, [](L x) { return std::tanh(x); }, 0.1, 20.0),
            4.0);  // one exp, one difference, one quotient
  EXPECT_LT(
      worst([](double x) { return atan2(x, -0.7); }, [](L x) { return std::atan2(x, L(-0.7)); }, -5.0, 5.0),
      3.0);
}

TEST(Math, KeepsNotANumberAndTheAxes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(sin(nan)) && std::isnan(cos(nan)) && std::isnan(atan(nan)) && std::isnan(exp(nan)));
  EXPECT_TRUE(std::isnan(log(-1.0)) && std::isnan(atan2(nan, 1.0)) && std::isnan(sin(1e300)));
  EXPECT_EQ(atan2(0.0, -1.0), kPi);
  EXPECT_EQ(atan2(-1.0, 0.0), -kPi / 2);
  EXPECT_EQ(sin(0.0), 0.0);
  EXPECT_EQ(cos(0.0), 1.0);
  EXPECT_EQ(exp(0.0), 1.0);
}

/// Every lane of a pack against the scalar call, bit by bit; ordinary arguments and all the odd ones.
template <class Function>
void expect_same_bits(Function f, double low, double high) {
  using P = Pack<arch::Native, 8>;
  constexpr double kInf = std::numeric_limits<double>::infinity();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kOdd[] = {0.0,  -0.0,  1e300,  -1e300, 1e-310, 5e-324, kInf,   -kInf, kNan, 1.0,
                             -1.0, 709.5, -708.5, 0.4375, 0.6875, 1.1875, 2.4375, 22.5,  1e-5, 1e9};
  Random random{11};
  for (int turn = 0; turn < 3000; ++turn) {
    P x;
    for (std::size_t lane = 0; lane < 8; ++lane)
      x.set(lane, turn < 20 ? kOdd[(static_cast<std::size_t>(turn) + lane) % 20] : random.uniform(low, high));
    const P y = f(x);
    for (std::size_t lane = 0; lane < 8; ++lane) {
      const double scalar = f(x[lane]);
      if (std::isnan(scalar) && std::isnan(y[lane])) continue;
      ASSERT_EQ(std::bit_cast<std::uint64_t>(y[lane]), std::bit_cast<std::uint64_t>(scalar)) << x[lane];
    }
  }
}

TEST(Math, APackHasTheBitsOfTheScalarCalls) {
  expect_same_bits([](auto x) { return sin(x); }, -60.0, 60.0);
  expect_same_bits([](auto x) { return cos(x); }, -60.0, 60.0);
  expect_same_bits([](auto x) { return tan(x); }, -2.0, 2.0);
  expect_same_bits([](auto x) { return atan(x); }, -6.0, 6.0);
  expect_same_bits([](auto x) { return atan2(x, decltype(x)(-0.3)); }, -6.0, 6.0);
  expect_same_bits([](auto x) { return atan2(decltype(x)(0.0), x); }, -6.0, 6.0);
  expect_same_bits([](auto x) { return exp(x); }, -60.0, 60.0);
  expect_same_bits([](auto x) { return log(x); }, 1e-9, 60.0);
  expect_same_bits([](auto x) { return tanh(x); }, -23.0, 23.0);
  expect_same_bits([](auto x) { return sqrt(x); }, 0.0, 60.0);
}

TEST(Angle, WrapKeepsWhatIsAlreadyInRange) {
  for (double angle : {0.0, 1.0, -1.0, kPi, -3.14159, 3.14159}) EXPECT_EQ(wrap_angle(angle), angle);
}

TEST(Angle, WrapPutsHalfATurnOnThePositiveSide) {
  EXPECT_EQ(wrap_angle(-kPi), kPi);
  EXPECT_NEAR(wrap_angle(3.0 * kPi), kPi, 1e-15);
  EXPECT_GT(wrap_angle(-3.0 * kPi), 0.0);
}

TEST(Angle, WrapIsInRangeAndPointsTheSameWay) {
  Random random(1);
  for (int i = 0; i < 10000; ++i) {
    const double angle = random.uniform(-1000.0, 1000.0);
    const double wrapped = wrap_angle(angle);
    EXPECT_GT(wrapped, -kPi);
    EXPECT_LE(wrapped, kPi);
    // 1000 rad has an ulp of 1.1e-13, and up to 160 turns of rounding are taken off.
    EXPECT_NEAR(cos(wrapped), cos(angle), 1e-12);
    EXPECT_NEAR(sin(wrapped), sin(angle), 1e-12);
  }
}

TEST(Angle, DifferenceTakesTheShortWayAcrossTheCut) {
  EXPECT_NEAR(angle_difference(-3.0, 3.0), kTwoPi - 6.0, 1e-15);
  EXPECT_NEAR(angle_difference(3.0, -3.0), 6.0 - kTwoPi, 1e-15);
  EXPECT_NEAR(angle_difference(0.5, 0.2), 0.3, 1e-15);
  EXPECT_NEAR(angle_difference(0.2 + 4.0 * kTwoPi, 0.5), -0.3, 1e-13);
}

TEST(Angle, UnitsOfTheRimConvertBackAndForth) {
  EXPECT_EQ(degrees_to_radians(180.0), kPi);
  EXPECT_NEAR(radians_to_degrees(degrees_to_radians(25.0)), 25.0, 1e-14);
  EXPECT_EQ(mph_to_mps(100.0), 44.704);
  EXPECT_NEAR(mps_to_mph(mph_to_mps(60.0)), 60.0, 1e-14);
}

TEST(Math, TheMedianIsTheUpperOfTwoInTheMiddle) {
  std::vector<double> values{5.0, 1.0, 3.0, 4.0};
  EXPECT_EQ(median(values), 4.0);
  EXPECT_EQ(values[0], 5.0) << "a copy is sorted";
  EXPECT_EQ(median(std::span(values).first(3)), 3.0);
}

}  // namespace
}  // namespace chicane
