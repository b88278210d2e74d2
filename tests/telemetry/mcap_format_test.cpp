// SPDX-License-Identifier: MIT
#include "chicane/telemetry/mcap.hpp"
#include "support/chicane_test.hpp"

namespace chicane::telemetry::mcap {
namespace {

TEST(McapFormat, ChecksumIsThatOfIeee8023) {
  EXPECT_EQ(crc32(""), 0u);
  EXPECT_EQ(crc32("123456789"), 0xcbf43926u);  // the check value of CRC-32/ISO-HDLC
  EXPECT_EQ(crc32("6789", crc32("12345")), crc32("123456789"));
}

TEST(McapFormat, NumbersAreLittleEndianAndTextsHaveTheirLengthInFront) {
  std::string bytes;
  Fields{bytes}.number(std::uint16_t{0x1234}).text("ab");
  EXPECT_EQ(bytes, std::string("\x34\x12\x02\0\0\0ab", 8));
}

TEST(McapFormat, ReadsWhatItWrote) {
  std::string bytes;
  Fields{bytes}.number(std::uint64_t{1} << 63).text("").text("topic").number(std::uint8_t{7});
  FieldReader reader{bytes};
  EXPECT_EQ(reader.number<std::uint64_t>(), std::uint64_t{1} << 63);
  EXPECT_EQ(reader.text(), "");
  EXPECT_EQ(reader.text(), "topic");
  EXPECT_EQ(reader.rest().size(), 1u);
  EXPECT_EQ(reader.number<std::uint8_t>(), 7);
  EXPECT_FALSE(reader.is_short());
}

TEST(McapFormat, ReadsZerosForEverAfterAnEndThatCameTooEarly) {
  FieldReader reader{std::string_view("\x05\0\0\0abc\x01", 8)};
  EXPECT_EQ(reader.text(), "") << "five bytes announced, four there";
  EXPECT_TRUE(reader.is_short());
  EXPECT_EQ(reader.number<std::uint8_t>(), 0);
  EXPECT_TRUE(reader.is_short());
}

}  // namespace
}  // namespace chicane::telemetry::mcap
