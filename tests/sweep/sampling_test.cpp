// SPDX-License-Identifier: MIT
#include "chicane/sweep/plan.hpp"
#include "support/chicane_test.hpp"

namespace chicane::sweep {
namespace {

TEST(Sobol, EachBlockOfAPowerOfTwoHasOneNumberInEachPart) {
  for (const std::uint64_t seed : {0U, 7U}) {
    for (int dimension = 0; dimension < kSobolDimensions; ++dimension) {
      for (const std::uint32_t begin : {0U, 64U, 4096U}) {
        std::set<int> parts;
        for (std::uint32_t i = 0; i < 64; ++i)
          parts.insert(static_cast<int>(64.0 * sobol(begin + i, dimension, seed)));
        EXPECT_EQ(parts.size(), 64U) << dimension;
        EXPECT_GE(*parts.begin(), 0);
        EXPECT_LE(*parts.rbegin(), 63);
      }
    }
  }
}

TEST(Sobol, BeginsAsPublished) {
  // Joe and Kuo's sobol.cc, points 1 to 4 of three dimensions.
  const std::vector<std::vector<double>> points{
      {0.5, 0.5, 0.5}, {0.75, 0.25, 0.25}, {0.25, 0.75, 0.75}, {0.375, 0.375, 0.625}};
  for (std::uint32_t i = 0; i < points.size(); ++i)
    for (int d = 0; d < 3; ++d)
      EXPECT_EQ(sobol(i + 1, d, 0), points[i][static_cast<std::size_t>(d)]) << i << " " << d;
}

TEST(Sobol, TwoDimensionsTogetherFillTheSquare) {
  for (int other = 1; other < kSobolDimensions; ++other) {
    std::set<int> cells;
    for (std::uint32_t i = 0; i < 1024; ++i)
      cells.insert(8 * static_cast<int>(8.0 * sobol(i, 0, 0)) + static_cast<int>(8.0 * sobol(i, other, 0)));
    EXPECT_EQ(cells.size(), 64U) << other;
  }
}

TEST(LatinHypercube, EachPartHasOnePointForAnyNumberOfThem) {
  for (const std::uint32_t count : {1U, 2U, 3U, 10U, 97U, 1000U}) {
    for (int dimension = 0; dimension < 3; ++dimension) {
      std::set<std::uint32_t> parts;
      for (std::uint32_t i = 0; i < count; ++i) {
        const double x = latin_hypercube(i, count, dimension, 5);
        ASSERT_GE(x, 0.0);
        ASSERT_LT(x, 1.0);
        parts.insert(static_cast<std::uint32_t>(x * count));
      }
      EXPECT_EQ(parts.size(), count);
    }
  }
}

TEST(LatinHypercube, DependsOnSeedAndDimension) {
  EXPECT_NE(latin_hypercube(3, 100, 0, 1), latin_hypercube(3, 100, 0, 2));
  EXPECT_NE(latin_hypercube(3, 100, 0, 1), latin_hypercube(3, 100, 1, 1));
  EXPECT_EQ(latin_hypercube(3, 100, 0, 1), latin_hypercube(3, 100, 0, 1));
}

}  // namespace
}  // namespace chicane::sweep
