// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "chicane/protocol/ros_messages.hpp"
#include "chicane/ros/dds.hpp"
#include "chicane/telemetry/frame.hpp"

namespace chicane::ros {

/// Sends a run as ROS 2 topics: those that viewers and recordings have, but for the ones that a car or its
/// simulator sends (odometry, transforms, drive, clock). Only what somebody reads is encoded. One thread.
///
/// The estimate of the car goes as /chicane/odom. Stamps are those of the system clock. The road's lines are
/// transient local: who comes late gets them, too.
class RunPublisher {
 public:
  /// `run` outlives this. kIo when DDS refuses a topic.
  [[nodiscard]] static Result<std::unique_ptr<RunPublisher>> create(Participant& participant,
                                                                    const protocol::Run& run);

  /// After a control cycle. `offset`: from the run's time to seconds since 1970 [s].
  void publish(const telemetry::Frame& frame, double offset);
  void publish(const telemetry::CompletedLap& lap);

 private:
  struct Topic {
    const protocol::RosTopic* topic = nullptr;
    std::unique_ptr<Writer> writer{};
    double period = 0.0;  ///< between messages at least [s]
    double last = -1e9;   ///< when one was sent [s]
    int readers = 0;      ///< when it was looked at last
  };

  explicit RunPublisher(const protocol::Run& run) : run_{run} {}

  const protocol::Run& run_;
  std::vector<Topic> topics_;
  telemetry::Frame shifted_;
};

}  // namespace chicane::ros
