// SPDX-License-Identifier: MIT
#include "chicane/survey/image.hpp"
#include "chicane/base/random.hpp"
#include "support/chicane_test.hpp"

namespace chicane::survey {
namespace {

/// Three cells by two: the upper row black, unknown and white, the lower row white, white and black.
constexpr std::string_view kText = "P2\n# made by hand\n3 2 255\n0 205 254\n254 254 0\n";

TEST(Image, ReadsTextBinaryAndPngAlike) {
  const auto text = test::good(read_image(kText, "m.pgm"));
  using namespace std::string_view_literals;
  const auto binary = test::good(read_image("P5 3 2 255\n\0\xcd\xfe\xfe\xfe\0"sv, "m.pgm"));
  EXPECT_EQ(text->values, binary->values);
  // The same six values as an 8-bit grey PNG, by Python's zlib.
  const auto png =
      test::good(read_image("\211\120\116\107\015\012\032\012\000\000\000\015\111\110\104\122\000\000\000\003"
                            "\000\000\000\002\010\000\000\000\000\270\037\071\306\000\000\000\020\111\104\101"
                            "\124\170\234\143\140\070\373\217\341\337\077\006\000\016\302\003\310\016\266\251"
                            "\064\000\000\000\000\111\105\116\104\256\102\140\202"sv,
                            "m.png"));
  EXPECT_EQ(png->values, text->values);
}

TEST(Image, RefusesImagesThatAreCutOffTooLargeOrOfAnotherKind) {
  const auto fault = [](std::string_view bytes) { return test::refusal_of(read_image(bytes, "m.pgm")); };
  EXPECT_EQ(fault("P5 3 2 255\nabc"), "m.pgm: grey value 4 of 6: got none, expected 0 to 255");
  EXPECT_EQ(fault("P2 1 1 100 101"), "m.pgm: grey value 1 of 1: got 101, expected 0 to 100");
  EXPECT_EQ(fault("P5 99999 99999 255\n"), "m.pgm: size: got 99999 x 99999, expected 1 to 64000000 cells");
  EXPECT_EQ(fault("P5 20000 20000 255\n"), "m.pgm: size: got 20000 x 20000, expected 1 to 64000000 cells");
  EXPECT_EQ(fault("P5 3 2 65535\n"), "m.pgm: largest grey value: got 65535, expected 1 to 255");
  EXPECT_EQ(fault("GIF89a"), "m.pgm: got other bytes, expected a PGM (P2, P5) or PNG image");
  EXPECT_EQ(fault("\x89PNG and nothing").substr(0, 6), "m.pgm:");
}

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
