// SPDX-License-Identifier: MIT
#include "chicane/road/racing_line.hpp"

#include <gtest/gtest.h>

namespace chicane::road {
namespace {

/// 100 m in 5 s: points at 0, 40 and 100 m.
RacingLine line() {
  RacingLine line;
  line.length = 100.0;
  line.points = {{.s = 0.0, .time = 0.0, .offset = 1.0, .vx = 20.0, .throttle = 1.0},
                 {.s = 40.0, .time = 2.0, .offset = 3.0, .vx = 10.0, .throttle = -1.0},
                 {.s = 100.0, .time = 5.0, .offset = 1.0, .vx = 20.0, .throttle = 1.0}};
  return line;
}

TEST(RacingLine, InterpolatesEveryValueBetweenItsPoints) {
  const RacingLinePoint p = line().at(10.0);
  EXPECT_DOUBLE_EQ(p.s, 10.0);
  EXPECT_DOUBLE_EQ(p.time, 0.5);
  EXPECT_DOUBLE_EQ(p.offset, 1.5);
  EXPECT_DOUBLE_EQ(p.vx, 17.5);
  EXPECT_DOUBLE_EQ(p.throttle, 0.5);
}

TEST(RacingLine, GoesRoundTheLapInBothDirections) {
  EXPECT_DOUBLE_EQ(line().at(110.0).offset, 1.5);
  EXPECT_DOUBLE_EQ(line().at(-60.0).offset, 3.0);
  EXPECT_DOUBLE_EQ(line().at(100.0).time, 0.0);
}

TEST(RacingLine, HasTheLastPointsTimeAsItsLapTime) { EXPECT_DOUBLE_EQ(line().lap_time(), 5.0); }

TEST(RacingLine, AnEmptyOneAnswersZeros) {
  EXPECT_TRUE(RacingLine{}.is_empty());
  EXPECT_EQ(RacingLine{}.at(3.0).vx, 0.0);
  EXPECT_EQ(RacingLine{}.lap_time(), 0.0);
}

}  // namespace
}  // namespace chicane::road
