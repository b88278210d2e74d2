// SPDX-License-Identifier: MIT
#include "chicane/base/random.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

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
