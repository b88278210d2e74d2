// SPDX-License-Identifier: MIT
// A partner for two_processes.py, which asks for something or does it wrong: ros_partner DOMAIN SECONDS WHAT
//
// stop, go         tells the controller to stop the car, to drive on
// best-effort      odometry with a quality of service that a reliable reader cannot use
// wrong-type       another type on the topic of the odometry
// reliable-reader  a reader of /drive that wants reliable messages
// clock            odometry of a car that stands; its clock jumps by 5 s
// twice            each message twice, each tenth late
// garbage          now and then bytes that are no message
// no-numbers       now and then numbers that are not finite
// odom-frame       odometry in a frame that a transform leads to
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "chicane/protocol/car_messages.hpp"
#include "chicane/ros/dds.hpp"

namespace {

using chicane::protocol::OdometryMessage;
using chicane::ros::Participant;
using chicane::ros::Writer;
using std::chrono::milliseconds;

constexpr const char* kOdometry = "/ego_racecar/odom";
constexpr std::int64_t kJump = 5'000'000'000;

OdometryMessage standing() {
  return {.stamp = std::chrono::duration_cast<std::chrono::nanoseconds>(
                       std::chrono::system_clock::now().time_since_epoch())
                       .count(),
          .frame = "map",
          .child_frame = "ego_racecar/base_link"};
}

void send(Writer& writer, const std::string& fault, int count) {
  OdometryMessage message = standing();
  if (fault == "clock" && count > 100) message.stamp += kJump;
  if (fault == "garbage" && count % 10 == 5) return void(writer.write(std::string("\0\1\0\0what", 8)));
  if (fault == "odom-frame") message.frame = "odom";
  if (fault == "no-numbers" && count % 10 == 0) message.pose.x = std::numeric_limits<double>::quiet_NaN();
  if (fault == "twice" && count % 10 == 0) message.stamp -= 30'000'000;
  writer.write(encode(message));
  if (fault == "twice") writer.write(encode(message));
}

int tell_stop(Participant& node, bool wanted) {
  auto writer = node.writer("/chicane/stop", std::string(chicane::protocol::BoolMessage::kType), {});
  if (!writer) return 3;
  for (int i = 0; i < 100 && (*writer)->matched() == 0; ++i) std::this_thread::sleep_for(milliseconds{20});
  std::this_thread::sleep_for(milliseconds{100});
  (*writer)->write(encode(chicane::protocol::BoolMessage{wanted}));
  std::this_thread::sleep_for(milliseconds{100});
  return 0;
}

}  // namespace

int main(int count, char** words) {
  if (count != 4) return 2;
  const std::string fault = words[3];
  auto node = Participant::create({.domain = std::atoi(words[1])});
  if (!node) return 3;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds{std::atoi(words[2])};
  if (fault == "stop" || fault == "go") return tell_stop(**node, fault == "stop");
  if (fault == "reliable-reader") {
    auto reader = (*node)->reader("/drive", std::string(chicane::protocol::DriveMessage::kType), {});
    std::this_thread::sleep_until(end);
    return reader ? 0 : 3;
  }
  const std::string type = fault == "wrong-type" ? "geometry_msgs/msg/PoseWithCovarianceStamped"
                                                 : std::string(OdometryMessage::kType);
  auto writer = (*node)->writer(kOdometry, type, {.is_reliable = fault != "best-effort"});
  if (!writer) return 3;
  std::unique_ptr<Writer> transforms;
  if (fault == "odom-frame") {
    auto made =
        (*node)->writer("/tf", std::string(chicane::protocol::TransformsMessage::kType), {.depth = 100});
    if (!made) return 3;
    transforms = std::move(*made);
  }
  for (int i = 1; std::chrono::steady_clock::now() < end; ++i) {
    if (transforms) {
      transforms->write(
          encode(chicane::protocol::TransformsMessage{{{standing().stamp, "map", "odom", {.x = 1.0}}}}));
    }
    send(**writer, fault, i);
    std::this_thread::sleep_for(milliseconds{20});
  }
  return 0;
}
