// SPDX-License-Identifier: MIT
// Our bytes against those of another vendor's CDR, eProsima Fast CDR. Odometry, commands and stops of whole
// laps are compared by fast_relay.cpp.
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include "chicane/protocol/car_messages.hpp"
#include "support/chicane_test.hpp"

namespace chicane::protocol {
namespace {

constexpr std::int64_t kStamp = 1'700'000'001'250'000'007;

/// One message by Fast CDR, with its header.
class Other {
 public:
  Other() : cdr_{buffer_, eprosima::fastcdr::Cdr::LITTLE_ENDIANNESS, eprosima::fastcdr::Cdr::DDS_CDR} {
    cdr_.serialize_encapsulation();
  }
  template <class... Values>
  Other& put(const Values&... values) {
    ((cdr_ << values), ...);
    return *this;
  }
  Other& stamp() { return put(std::int32_t{1'700'000'001}, std::uint32_t{250'000'007}); }
  Other& pose(double x, double y, double yaw) {
    return put(x, y, 0.0, 0.0, 0.0, std::sin(0.5 * yaw), std::cos(0.5 * yaw));
  }
  template <std::size_t N>
  Other& zeros() {
    return put(std::array<double, N>{});
  }
  [[nodiscard]] std::string bytes() { return {buffer_.getBuffer(), cdr_.getSerializedDataLength()}; }

 private:
  std::vector<char> memory_ = std::vector<char>(4096);  // zeros: Fast CDR leaves padding as it finds it
  eprosima::fastcdr::FastBuffer buffer_{memory_.data(), memory_.size()};
  eprosima::fastcdr::Cdr cdr_;
};

TEST(OtherVendor, WritesCommandsAsWeDo) {
  const DriveMessage message{
      .stamp = kStamp, .frame = "base", .steer = 0.1, .speed = 4.0, .acceleration = -2.0};
  EXPECT_EQ(encode(message), Other().stamp().put(std::string("base"), 0.1F, 0.0F, 4.0F, -2.0F, 0.0F).bytes());
  Other control;
  control.stamp().stamp().stamp().stamp().put(0.1F, 0.0F, false);
  control.stamp().stamp().put(4.0F, -2.0F, 0.0F, true, false);
  EXPECT_EQ(encode(AutowareMessage{message}), control.bytes());
}

TEST(OtherVendor, WritesSensorsAsWeDo) {
  Other imu;
  imu.stamp().put(std::string("imu"), 0.0, 0.0, 0.0, 1.0, -1.0).zeros<8>();
  imu.put(0.0, 0.0, 0.5).zeros<9>().put(1.0, 2.0, 0.0).zeros<9>();
  EXPECT_EQ(encode(ImuMessage{.stamp = kStamp, .frame = "imu", .yaw_rate = 0.5, .ax = 1.0, .ay = 2.0}),
            imu.bytes());
  Other scan;
  scan.stamp().put(std::string("laser"), -1.0F, 0.0F, 0.5F, 0.0F, 0.025F, 0.02F, 30.0F);
  scan.put(std::vector<float>{1.0F, 2.0F, 3.0F}, std::vector<float>{});
  EXPECT_EQ(encode(ScanMessage{.stamp = kStamp,
                               .frame = "laser",
                               .angle_min = -1.0,
                               .angle_increment = 0.5,
                               .scan_time = 0.025,
                               .range_min = 0.02,
                               .range_max = 30.0,
                               .ranges = {1.0F, 2.0F, 3.0F}}),
            scan.bytes());
}

TEST(OtherVendor, WritesPosesAsWeDo) {
  Other path;
  path.stamp().put(std::string("map"), std::uint32_t{2});
  path.stamp().put(std::string("map")).pose(1.0, 2.0, std::atan2(2.0, 2.0));
  path.stamp().put(std::string("map")).pose(3.0, 4.0, std::atan2(2.0, 2.0));
  EXPECT_EQ(encode(path_along(kStamp, "map", std::vector<Vec2>{{1.0, 2.0}, {3.0, 4.0}})), path.bytes());
  EXPECT_EQ(encode(PoseMessage{.stamp = kStamp, .frame = "map", .pose = {.x = 1.0, .y = 2.0, .psi = 0.0}}),
            Other().stamp().put(std::string("map")).pose(1.0, 2.0, 0.0).zeros<36>().bytes());
  EXPECT_EQ(encode(TransformsMessage{{{kStamp, "map", "base", {.x = 1.0}}}}),
            Other()
                .put(std::uint32_t{1})
                .stamp()
                .put(std::string("map"), std::string("base"))
                .pose(1.0, 0.0, 0.0)
                .bytes());
}

TEST(OtherVendor, WritesFlagsAndParametersAsWeDo) {
  EXPECT_EQ(encode(BoolMessage{true}), Other().put(true).bytes());
  EXPECT_EQ(encode(ClockMessage{kStamp}), Other().stamp().bytes());
  EXPECT_EQ(encode(NamesRequest{.call = {7, 8}, .names = {"a"}}),
            Other()
                .put(std::uint64_t{7}, std::int64_t{8}, std::vector<std::string>{"a"}, std::uint64_t{0})
                .bytes());
}

}  // namespace
}  // namespace chicane::protocol
