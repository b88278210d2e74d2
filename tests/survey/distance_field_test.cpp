// SPDX-License-Identifier: MIT
#include "chicane/survey/image.hpp"

#include "chicane/base/random.hpp"
#include "support/chicane_test.hpp"

namespace chicane::survey {
namespace {

TEST(DistanceField, IsThatOfTheNearestCellThatIsSet) {
  Random random(3);
  for (const double share : {0.5, 0.02, 0.002}) {
    constexpr int kWidth = 41, kHeight = 29;
    std::vector<std::uint8_t> mask(kWidth * kHeight, 0);
    for (std::uint8_t& cell : mask) cell = random.uniform() < share ? 1 : 0;
    mask[17] = 1;
    const std::vector<float> field = distance_field(mask, kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        double least = 1e9;
        for (int v = 0; v < kHeight; ++v)
          for (int u = 0; u < kWidth; ++u)
            if (mask[static_cast<std::size_t>(v * kWidth + u)] != 0)
              least = std::min(least, std::hypot(u - x, v - y));
        ASSERT_NEAR(static_cast<double>(field[static_cast<std::size_t>(y * kWidth + x)]), least, 1e-4)
            << x << ", " << y;
      }
  }
}

TEST(DistanceField, IsLargeWhereNothingIsSet) {
  for (const float away : distance_field(std::vector<std::uint8_t>(12, 0), 4, 3)) EXPECT_GT(away, 1e5F);
}

}  // namespace
}  // namespace chicane::survey
