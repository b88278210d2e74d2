// SPDX-License-Identifier: MIT
#include "chicane/base/text.hpp"

#include <gtest/gtest.h>

#include <array>

namespace chicane {
namespace {

enum class Weather : signed char { kDry = 0, kIce = -1 };
constexpr std::array kWeather{Word<Weather>{Weather::kDry, "dry", Severity::kOk, "the road is dry"},
                              Word<Weather>{Weather::kIce, "ice", Severity::kError, "the road is icy"}};

TEST(Word, IsFoundByItsValue) {
  static_assert(find_word<Weather>(kWeather, Weather::kIce)->name == "ice");
  EXPECT_EQ(find_word<Weather>(kWeather, Weather::kDry), kWeather.data());
  EXPECT_EQ(find_word<Weather>(kWeather, static_cast<Weather>(7)), nullptr);
}

TEST(Word, SeverityCountsAsRosDiagnosticsDo) {
  EXPECT_EQ(static_cast<int>(Severity::kOk), 0);
  EXPECT_EQ(static_cast<int>(Severity::kWarning), 1);
  EXPECT_EQ(static_cast<int>(Severity::kError), 2);
}

}  // namespace
}  // namespace chicane
