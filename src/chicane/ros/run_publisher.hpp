// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/protocol/foxglove_codec.hpp"
#include "chicane/protocol/ros_messages.hpp"
#include "chicane/ros/dds.hpp"
#include "chicane/telemetry/frame.hpp"

namespace chicane::ros {

/// Sends a run as ROS 2 topics: the topics of viewers and recordings, except those that a car or its
/// simulator sends (odometry, transforms, drive, clock). Only topics with a reader are encoded. One thread.
///
/// The estimate of the car goes as /chicane/odom. Stamps are those of the system clock. The road's lines are
/// transient local: late readers get them, too.
class RunPublisher {
 public:
  /// `run` outlives this. kIo when DDS refuses a topic.
  [[nodiscard]] static Result<std::unique_ptr<RunPublisher>> create(Participant& participant,
                                                                    const protocol::Run& run);

  /// Publishes a frame after its control cycle. `offset`: from the run's time to seconds since 1970 [s].
  void publish(const telemetry::Frame& frame, double offset);
  void publish(const telemetry::CompletedLap& lap);

 private:
  struct Topic {
    const protocol::RosTopic* topic = nullptr;
    std::unique_ptr<Writer> writer{};
    double period = 0.0;  ///< least time between messages [s]
    double last = -1e9;   ///< time of the last message [s]
    int readers = 0;      ///< readers at the last look
  };

  explicit RunPublisher(const protocol::Run& run) : run_{run} {}

  const protocol::Run& run_;
  std::vector<Topic> topics_;
  telemetry::Frame shifted_;
};

/// The six parameter services of the node /chicane, for clients of rmw_cyclonedds and of rmw_fastrtps. A
/// setting takes effect at the next control step, as one of a viewer does.
class ParameterServices {
 public:
  /// Runs a task on the thread to which the store belongs.
  using Run = std::function<void(std::function<void()>)>;

  /// `store` outlives the tasks. kIo when DDS refuses.
  [[nodiscard]] static Result<std::unique_ptr<ParameterServices>> create(
      Participant& participant, protocol::foxglove::ParameterStore& store, Run run);

  /// Hands requests since the last call to the store's thread, which answers.
  void serve();

 private:
  using Answer = std::string (*)(protocol::foxglove::ParameterStore& store, std::string_view request);
  struct Service {
    std::unique_ptr<Reader> requests{};
    std::shared_ptr<Writer> replies{};
    Answer answer = nullptr;
  };

  ParameterServices(protocol::foxglove::ParameterStore& store, Run run)
      : store_{store}, run_{std::move(run)} {}

  protocol::foxglove::ParameterStore& store_;
  Run run_;
  std::vector<Service> services_;
};

}  // namespace chicane::ros
