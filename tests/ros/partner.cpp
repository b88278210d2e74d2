// SPDX-License-Identifier: MIT
// A partner for two_processes.py, which asks for something or does it wrong: ros_partner DOMAIN SECONDS WHAT
//
// set              asks the controller's parameter service to set a weight
// stop, go         tells the controller to stop the car, to drive on
// best-effort      odometry with a quality of service that a reliable reader cannot use
// wrong-type       another type on the topic of the odometry
// reliable-reader  a reader of /drive that wants reliable messages
// clock            odometry of a car that stands; its clock jumps by 5 s
// twice            each message twice, each tenth late
// garbage          now and then bytes that are no message
// no-numbers       now and then numbers that are not finite
#include <chrono>
#include <cstdlib>
#include <limits>
#include <string>
#include <thread>

#include "chicane/protocol/car_messages.hpp"
#include "chicane/protocol/parameter_messages.hpp"
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
  if (fault == "no-numbers" && count % 10 == 0) message.pose.x = std::numeric_limits<double>::quiet_NaN();
  if (fault == "twice" && count % 10 == 0) message.stamp -= 30'000'000;
  writer.write(encode(message));
  if (fault == "twice") writer.write(encode(message));
}

int tell_stop(Participant& node, bool wanted) {
  auto writer = node.writer("/chicane/stop", std::string(chicane::protocol::kBoolType), {});
  if (!writer) return 3;
  for (int i = 0; i < 100 && (*writer)->matched() == 0; ++i) std::this_thread::sleep_for(milliseconds{20});
  std::this_thread::sleep_for(milliseconds{100});
  (*writer)->write(chicane::protocol::encode_bool(wanted));
  std::this_thread::sleep_for(milliseconds{100});
  return 0;
}

/// 0 when the service said that it did.
int set_weight(Participant& node, std::chrono::steady_clock::time_point end) {
  auto writer =
      node.writer("rq/chicane/set_parametersRequest", "rcl_interfaces/srv/SetParameters_Request", {});
  auto reader =
      node.reader("rr/chicane/set_parametersReply", "rcl_interfaces/srv/SetParameters_Response", {});
  if (!writer || !reader) return 3;
  while (std::chrono::steady_clock::now() < end && ((*writer)->matched() == 0 || (*reader)->matched() == 0))
    std::this_thread::sleep_for(milliseconds{20});
  (*writer)->write(
      chicane::protocol::encode_set_request({.parameters = {{"tracking_mpc.weight_lateral", 2.0}}}));
  while (std::chrono::steady_clock::now() < end) {
    node.wait(milliseconds{50});
    for (const auto& sample : (*reader)->take()) {
      const auto outcomes = chicane::protocol::decode_set_reply(sample.bytes);
      return outcomes && outcomes->size() == 1 && (*outcomes)[0].is_successful ? 0 : 1;
    }
  }
  return 1;
}

}  // namespace

int main(int count, char** words) {
  if (count != 4) return 2;
  const std::string fault = words[3];
  auto node = Participant::create({.domain = std::atoi(words[1])});
  if (!node) return 3;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds{std::atoi(words[2])};
  if (fault == "stop" || fault == "go") return tell_stop(**node, fault == "stop");
  if (fault == "set") return set_weight(**node, end);
  if (fault == "reliable-reader") {
    auto reader = (*node)->reader("/drive", std::string(chicane::protocol::DriveMessage::kType), {});
    std::this_thread::sleep_until(end);
    return reader ? 0 : 3;
  }
  const std::string type = fault == "wrong-type" ? "geometry_msgs/msg/PoseWithCovarianceStamped"
                                                 : std::string(OdometryMessage::kType);
  auto writer = (*node)->writer(kOdometry, type, {.is_reliable = fault != "best-effort"});
  if (!writer) return 3;
  for (int i = 1; std::chrono::steady_clock::now() < end; ++i) {
    send(**writer, fault, i);
    std::this_thread::sleep_for(milliseconds{20});
  }
  return 0;
}
