// SPDX-License-Identifier: MIT
// A ROS 2 program of one's own with nothing but Cyclone DDS: reads /scan and sends /drive, towards the free
// road. It drives the car of `chicane ros --simulate`; the same program drives an F1TENTH
// car.
#include <dds/dds.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "car.h"

using Scan = sensor_msgs_msg_dds__LaserScan_;
using Drive = ackermann_msgs_msg_dds__AckermannDriveStamped_;

/// This machine alone, as `chicane ros` without --interface.
constexpr const char* kLoopback =
    "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\"/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
    "<Peers><Peer Address=\"127.0.0.1\"/></Peers></Discovery></Domain></CycloneDDS>";

constexpr float kView = 1.0F;      // looks so far to each side [rad]
constexpr int kHalfWindow = 30;    // beams to each side of a direction that have to be free, too
constexpr float kAside = 1.3F;     // where the walls beside the car are [rad]
constexpr float kTopSpeed = 3.0F;  // [m/s]

/// The shortest range of the beams around an angle [m].
float free_at(const Scan& scan, float angle) {
  const auto count = static_cast<int>(scan.ranges._length);
  const int middle = static_cast<int>((angle - scan.angle_min) / scan.angle_increment);
  const int first = std::clamp(middle - kHalfWindow, 0, count - 1);
  const int end = std::clamp(middle + kHalfWindow + 1, 1, count);
  return *std::min_element(scan.ranges._buffer + first, scan.ranges._buffer + end);
}

/// Steers to where the road is free the furthest and to the middle of the road, the faster the further it is
/// free.
Drive answer(const Scan& scan) {
  float furthest = 0.0F, direction = 0.0F;
  for (float angle = -kView; angle <= kView; angle += 0.02F) {
    const float free = std::min(free_at(scan, angle), scan.range_max);
    if (free <= furthest) continue;
    furthest = free;
    direction = angle;
  }
  const float left = free_at(scan, kAside), right = free_at(scan, -kAside);
  const float to_middle = std::clamp(left - right, -1.0F, 1.0F);
  Drive drive{};
  drive.header.stamp = scan.header.stamp;
  drive.header.frame_id = const_cast<char*>("ego_racecar/base_link");  // Cyclone does not write to it
  drive.drive.steering_angle = std::clamp(0.5F * direction + 0.25F * to_middle, -0.4F, 0.4F);
  drive.drive.speed = std::clamp(0.8F * furthest, 0.5F, kTopSpeed);
  return drive;
}

int main(int count, char** words) {
  const auto domain = static_cast<dds_domainid_t>(count > 1 ? std::atoi(words[1]) : 0);
  dds_create_domain(domain, kLoopback);
  const dds_entity_t node = dds_create_participant(domain, nullptr, nullptr);
  // In ROS /scan and /drive: topics are called rt/... in DDS.
  const dds_entity_t scan_topic =
      dds_create_topic(node, &sensor_msgs_msg_dds__LaserScan__desc, "rt/scan", nullptr, nullptr);
  const dds_entity_t drive_topic = dds_create_topic(
      node, &ackermann_msgs_msg_dds__AckermannDriveStamped__desc, "rt/drive", nullptr, nullptr);
  // DDS's own defaults: a best-effort reader takes from any sender, a reliable writer reaches any reader.
  const dds_entity_t reader = dds_create_reader(node, scan_topic, nullptr, nullptr);
  dds_qos_t* const reliable = dds_create_qos();
  dds_qset_reliability(reliable, DDS_RELIABILITY_RELIABLE, DDS_MSECS(10));
  const dds_entity_t writer = dds_create_writer(node, drive_topic, reliable, nullptr);
  dds_delete_qos(reliable);
  if (writer < 0 || reader < 0) {
    std::fprintf(stderr, "DDS: %s\n", dds_strretcode(-std::min(reader, writer)));
    return 3;
  }
  const dds_entity_t waiting = dds_create_waitset(node);
  dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS);
  dds_waitset_attach(waiting, reader, 0);
  std::puts("follows the gap in /scan (Ctrl-C ends)");
  for (;;) {
    dds_waitset_wait(waiting, nullptr, 0, DDS_SECS(1));
    void* sample = nullptr;
    dds_sample_info_t info;
    while (dds_take(reader, &sample, &info, 1, 1) > 0) {
      if (info.valid_data) {
        const Drive drive = answer(*static_cast<const Scan*>(sample));
        dds_write(writer, &drive);
      }
      dds_return_loan(reader, &sample, 1);
      sample = nullptr;
    }
  }
}
