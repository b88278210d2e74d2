// SPDX-License-Identifier: MIT
#include "chicane/sweep/page_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace chicane::sweep {
namespace {

TEST(PageText, LeavesNoMarkupInWhatIsShown) {
  EXPECT_EQ(escaped("a < b & c > d"), "a &lt; b &amp; c &gt; d");
  EXPECT_THAT(escaped("\"'><script>"), testing::Not(testing::ContainsRegex("[<>\"]")));
  EXPECT_THAT(page_head("<b>"), testing::Not(testing::HasSubstr("<b>")));
  EXPECT_THAT(page_head("Lap 1"), testing::HasSubstr("<title>Lap 1"));
}

TEST(PageText, QuotesACellWhereItHasTo) {
  EXPECT_EQ(csv_cell("plain"), "plain");
  EXPECT_EQ(csv_cell("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_cell("say \"x\""), "\"say \"\"x\"\"\"");
  EXPECT_EQ(csv_cell("two\nlines"), "\"two\nlines\"");
}

}  // namespace
}  // namespace chicane::sweep
