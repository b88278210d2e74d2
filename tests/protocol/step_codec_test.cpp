// SPDX-License-Identifier: MIT
#include "chicane/protocol/step_codec.hpp"

#include <bit>

#include "chicane/protocol/ros_messages.hpp"
#include "support/chicane_test.hpp"

namespace chicane::protocol {
namespace {

TEST(StepCodec, KeepsEveryBit) {
  telemetry::Frame frame;
  frame.cycle = 7;
  frame.measurement.x = std::bit_cast<double>(0x7ff8000000000123ULL);  // a not-a-number with a payload
  frame.measurement.waypoint_count = 2;
  frame.measurement.waypoints[1] = {-0.0, 5e-324};
  frame.result.command = {.steer = 0.1, .throttle = -0.3};
  frame.is_manual = true;
  frame.manual = {.steer = -0.2, .throttle = 0.4};
  frame.gate_interval = 0.040000000001;
  frame.longest_interval = 0.42;
  frame.deadline_spent_at = 9;
  frame.begins = true;
  frame.has_measurement = false;
  const auto step = test::good(decode_step(encode_step(frame)));
  EXPECT_EQ(step->cycle, 7U);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(step->measurement.x), 0x7ff8000000000123ULL);
  EXPECT_TRUE(std::signbit(step->measurement.waypoints[1].x()));
  EXPECT_EQ(step->measurement.waypoints[1].y(), 5e-324);
  EXPECT_EQ(step->command.throttle, -0.3);
  ASSERT_TRUE(step->manual);
  EXPECT_EQ(step->manual->steer, -0.2);
  EXPECT_EQ(step->gate_interval, 0.040000000001);
  EXPECT_EQ(step->longest_interval, 0.42);
  EXPECT_EQ(step->deadline_spent_at, 9U);
  EXPECT_TRUE(step->begins);
  EXPECT_FALSE(step->has_measurement);
}

TEST(StepCodec, RefusesEveryShorterAndALongerMessage) {
  telemetry::Frame frame;
  frame.measurement.waypoint_count = 3;
  const std::string bytes = encode_step(frame);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(decode_step(std::string_view(bytes).substr(0, size))) << size;
  }
  EXPECT_FALSE(decode_step(bytes + "x"));
}

TEST(StepCodec, ReadsChangesOfAnyLength) {
  for (const char* name : {"a", "ab", "abc", "abcd", "tracking_mpc.horizon_steps"}) {
    const std::string bytes = encode_change(12.25, 306, name, "20");
    const auto change = decode_change(bytes);
    ASSERT_TRUE(change) << name;
    EXPECT_EQ(change->name.view(), name);
    EXPECT_EQ(change->value.view(), "20");
    EXPECT_EQ(change->cycle, 306U);
    EXPECT_EQ(change->time, 12.25);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_FALSE(decode_change(std::string_view(bytes).substr(0, size))) << size;
    }
  }
  EXPECT_FALSE(decode_change(encode_change(0.0, 0, std::string(65, 'x'), "")));
}

}  // namespace
}  // namespace chicane::protocol
