// SPDX-License-Identifier: MIT
#include "chicane/model/actuator.hpp"
#include "support/chicane_test.hpp"

namespace chicane::model {
namespace {

TEST(Actuator, LagsExactlyAndKeepsRangeAndRate) {
  const Actuator lagging{.low = -1.0, .high = 1.0, .lag = 0.1};
  double value = 0.0;
  for (int i = 0; i < 100; ++i) value = lagging.next(value, 0.5, 0.001);
  EXPECT_NEAR(value, 0.5 * (1.0 - std::exp(-1.0)), 1e-12);  // composition of exact steps
  EXPECT_EQ(Actuator{}.next(0.0, 9.0, 0.001), 1.0);
  const Actuator slow{.low = -1.0, .high = 1.0, .lag = 0.0, .rate = 2.0};
  EXPECT_NEAR(slow.next(0.0, 1.0, 0.1), 0.2, 1e-15);
  EXPECT_NEAR(slow.next(0.0, -1.0, 0.1), -0.2, 1e-15);
}

TEST(Actuator, NeverLeavesItsRangeNorMovesWithoutTime) {
  const Actuator actuator{.low = -0.2, .high = 0.7, .lag = 0.05, .rate = 3.0};
  EXPECT_EQ(actuator.next(0.4, -5.0, 0.0), 0.4);
  double value = 0.0;
  for (int i = 0; i < 1000; ++i) {
    value = actuator.next(value, i % 200 < 100 ? 9.0 : -9.0, 0.01);
    EXPECT_LE(value, 0.7);
    EXPECT_GE(value, -0.2);
  }
}

}  // namespace
}  // namespace chicane::model
