// SPDX-License-Identifier: MIT
#include "chicane/base/pack.hpp"

#include <bit>

#include "base/pack_cases.hpp"
#include "chicane/base/random.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

using test::kCaseCount;
using test::kCaseLanes;

struct Operands {
  double a[kCaseLanes];
  double b[kCaseLanes];
  double c[kCaseLanes];
};

Operands random_operands(Random& random) {
  Operands o{};
  for (std::size_t i = 0; i < kCaseLanes; ++i) {
    o.a[i] = random.uniform(-3.0, 3.0);
    o.b[i] = random.uniform() < 0.1 ? o.a[i] : random.uniform(-3.0, 3.0);
    o.c[i] = random.uniform(-3.0, 3.0);
    const double kind = random.uniform();
    if (kind < 0.05) o.b[i] = 0.0;
    if (kind > 0.95) o.a[i] = std::numeric_limits<double>::quiet_NaN();
    if (kind > 0.5 && kind < 0.55) o.a[i] = 0.5 + std::floor(o.a[i]);
    if (kind > 0.55 && kind < 0.58) o.a[i] *= 1e17;
  }
  return o;
}

void run(InstructionSet set, const Operands& o, double (*result)[kCaseLanes]) {
  with_instructions(set, [&](auto arch) { test::run_pack_cases<decltype(arch)>(o.a, o.b, o.c, result); });
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (a != a && b != b);
}

TEST(Pack, ComputesLaneByLaneWhatDoublesCompute) {
  Random random{1};
  for (int trial = 0; trial < 2000; ++trial) {
    const Operands o = random_operands(random);
    for (const auto set : {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
      if (!is_available(set)) continue;
      const bool fused = arithmetic(set) == "fused";
      double got[kCaseCount][kCaseLanes];
      run(set, o, got);
      for (std::size_t i = 0; i < kCaseLanes; ++i) {
        const double a = o.a[i];
        const double b = o.b[i];
        const double c = o.c[i];
        const double expected[] = {a + b,
                                   a - b,
                                   a * b,
                                   a / b,
                                   -a,
                                   fused ? std::fma(a, b, c) : a * b + c,
                                   fused ? std::fma(-a, b, c) : c - a * b,
                                   a < b ? a : b,
                                   a > b ? a : b,
                                   std::fabs(a),
                                   std::sqrt(std::fabs(a)),
                                   std::nearbyint(a),
                                   std::copysign(a, b),
                                   a < b ? 1.0 : 0.0,
                                   a <= b ? 1.0 : 0.0,
                                   a == b ? 1.0 : 0.0,
                                   a < b && !(b < c) ? 1.0 : 0.0,
                                   a < b || c > 1.0 ? 1.0 : 0.0,
                                   std::isfinite(a / b) ? 1.0 : 0.0,
                                   i < 3 ? 1.0 : 0.0};
        for (std::size_t row = 0; row < std::size(expected); ++row) {
          ASSERT_TRUE(same_bits(got[row][i], expected[row]))
              << to_string(set) << ", case " << row << ", lane " << i << ": " << got[row][i] << " for "
              << expected[row] << " of " << a << ", " << b << ", " << c;
        }
      }
    }
  }
}

TEST(Pack, GivesTheSameBitsForEveryWidthOfRegisters) {
  if (!is_available(InstructionSet::kAvx512) || !is_available(InstructionSet::kAvx2))
    GTEST_SKIP() << "needs a processor with AVX-512 and a build with CHICANE_SIMD=all";
  Random random{2};
  for (int trial = 0; trial < 2000; ++trial) {
    const Operands o = random_operands(random);
    double narrow[kCaseCount][kCaseLanes];
    double wide[kCaseCount][kCaseLanes];
    run(InstructionSet::kAvx2, o, narrow);
    run(InstructionSet::kAvx512, o, wide);
    for (std::size_t row = 0; row < kCaseCount; ++row) {
      for (std::size_t i = 0; i < kCaseLanes; ++i)
        ASSERT_TRUE(same_bits(narrow[row][i], wide[row][i])) << "case " << row << ", lane " << i;
    }
  }
}

template <std::size_t N>
void expect_transposed() {
  Pack<arch::Baseline, N> row[N];
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j) row[i].set(j, 10.0 * static_cast<double>(i) + static_cast<double>(j));
  }
  transpose(row);
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j)
      EXPECT_EQ(row[i][j], 10.0 * static_cast<double>(j) + static_cast<double>(i));
  }
}

TEST(Pack, TransposesSquares) {
  expect_transposed<2>();
  expect_transposed<4>();
  expect_transposed<8>();
}

}  // namespace
}  // namespace chicane
