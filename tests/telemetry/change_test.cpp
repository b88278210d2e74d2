// SPDX-License-Identifier: MIT
#include "chicane/telemetry/metrics.hpp"
#include "support/chicane_test.hpp"

namespace chicane::telemetry {
namespace {

TEST(ShortText, KeepsWhatFitsAndCutsTheRest) {
  EXPECT_EQ(ShortText<4>{}.view(), "");
  EXPECT_EQ(ShortText<4>{"abcd"}.view(), "abcd");
  EXPECT_EQ(ShortText<4>{std::string("abcdef")}.view(), "abcd");
  EXPECT_TRUE(ShortText<4>::fits("abcd"));
  EXPECT_FALSE(ShortText<4>::fits("abcde"));
}

TEST(Change, HasRoomForTheLongestKeyAndItsValue) {
  const std::string name(64, 'n');
  const std::string value(256, 'v');
  const Change change{.cycle = 3, .time = 0.12, .name = name, .value = value};
  const Change copy = change;
  EXPECT_EQ(copy.name.view(), name);
  EXPECT_EQ(copy.value.view(), value);
  EXPECT_FALSE(copy.starts_anew);
}

}  // namespace
}  // namespace chicane::telemetry
