// SPDX-License-Identifier: MIT
#include "chicane/base/random.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

TEST(Random, FollowsThePublishedStream) {
  // First outputs of SplitMix64 for seed 1234567, as printed by the reference C program (Vigna,
  // splitmix64.c).
  Random random(1234567);
  EXPECT_EQ(random.bits(), 6457827717110365317ULL);
  EXPECT_EQ(random.bits(), 3203168211198807973ULL);
  EXPECT_EQ(random.bits(), 9817491932198370423ULL);
}

TEST(Random, SameSeedSameNumbersOtherSeedOthers) {
  Random a(5), b(5), c(6);
  for (int i = 0; i < 100; ++i) {
    const double value = a.normal();
    EXPECT_EQ(value, b.normal());
    EXPECT_NE(value, c.normal());
  }
}

TEST(Random, UniformFillsItsRangeEvenly) {
  Random random(1);
  constexpr int kCount = 100000;
  double sum = 0.0, lowest = 1e9, highest = -1e9;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.uniform(-2.0, 4.0);
    ASSERT_GE(x, -2.0);
    ASSERT_LT(x, 4.0);
    sum += x;
    lowest = std::fmin(lowest, x);
    highest = std::fmax(highest, x);
  }
  EXPECT_NEAR(sum / kCount, 1.0, 4.0 * 6.0 / std::sqrt(12.0 * kCount));  // four standard errors of the mean
  EXPECT_LT(lowest, -1.99);
  EXPECT_GT(highest, 3.99);
}

TEST(Random, NormalHasTheMomentsOfANormal) {
  Random random(2);
  constexpr int kCount = 200000;
  double first = 0.0, second = 0.0, fourth = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.normal();
    ASSERT_TRUE(std::isfinite(x));
    first += x;
    second += x * x;
    fourth += x * x * x * x;
  }
  // Four standard errors: Var(x) = 1, Var(x²) = 2, Var(x⁴) = 96.
  EXPECT_NEAR(first / kCount, 0.0, 4.0 / std::sqrt(kCount));
  EXPECT_NEAR(second / kCount, 1.0, 4.0 * std::sqrt(2.0 / kCount));
  EXPECT_NEAR(fourth / kCount, 3.0, 4.0 * std::sqrt(96.0 / kCount));
}

std::uint64_t hash(double a, double b) {
  Fnv fnv;
  fnv.add(a);
  fnv.add(b);
  return fnv.value();
}

TEST(Fnv, OfNothingIsTheOffsetBasis) { EXPECT_EQ(Fnv{}.value(), 0xcbf29ce484222325ULL); }

TEST(Fnv, IsThePublishedFunction) {
  // FNV-1a-64 of the eight bytes "foobar\0\0": "foobar" hashes to 0x85944171f73967e8 (Noll's test vectors),
  // and each zero byte multiplies by the prime.
  Fnv fnv;
  fnv.add(std::uint64_t{0x00007261626f6f66});
  EXPECT_EQ(fnv.value(), 0x85944171f73967e8ULL * 0x100000001b3ULL * 0x100000001b3ULL);
}

TEST(Fnv, SeesTheLastBitAndTheOrder) {
  EXPECT_EQ(hash(1.0, 2.0), hash(1.0, 2.0));
  EXPECT_NE(hash(1.0, 2.0), hash(2.0, 1.0));
  EXPECT_NE(hash(1.0, 2.0), hash(1.0, 2.0000000000000004));
}

TEST(Fnv, TakesBothZerosForOne) { EXPECT_EQ(hash(0.0, 1.0), hash(-0.0, 1.0)); }

}  // namespace
}  // namespace chicane
