// SPDX-License-Identifier: MIT
// A run as ROS 2 topics, and its settings as the parameter services of a node.
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

/// Publisher of a run as ROS 2 topics: the topics of viewers and recordings, except those that a car or its
/// simulator sends (odometry, transforms, drive, clock). Only topics with a reader are encoded. One thread.
///
/// The car's estimated state is sent as /chicane/odom. Stamps are those of the system clock. The lines of the
/// road are transient local, so that late readers get them.
class RunPublisher {
 public:
  /// `run` outlives this. kIo when DDS refuses a topic.
  [[nodiscard]] static Result<std::unique_ptr<RunPublisher>> create(Participant& participant,
                                                                    const protocol::Run& run);

  /// Publishes a frame after its control cycle. `offset`: seconds since 1970 minus the run's time [s].
  void publish(const telemetry::Frame& frame, double offset);
  /// Publishes a completed lap.
  void publish(const telemetry::CompletedLap& lap);

 private:
  /// Topic that is sent.
  struct Topic {
    const protocol::RosTopic* topic = nullptr;  ///< name, type and encoder
    std::unique_ptr<Writer> writer{};
    double period = 0.0;  ///< least time between messages [s]
    double last = -1e9;   ///< run time of the last message [s]
  };

  explicit RunPublisher(const protocol::Run& run) : run_{run} {}

  const protocol::Run& run_;
  std::vector<Topic> topics_;
  telemetry::Frame shifted_;  ///< copy of the frame with times since 1970
};

/// The six parameter services of the node /chicane, for clients of rmw_cyclonedds and of rmw_fastrtps. A
/// setting takes effect at the next control step, as that of a viewer.
class ParameterServices {
 public:
  /// Runs a task on the thread to which the store belongs.
  using Run = std::function<void(std::function<void()>)>;

  /// `store` outlives the tasks. kIo when DDS refuses.
  [[nodiscard]] static Result<std::unique_ptr<ParameterServices>> create(
      Participant& participant, protocol::foxglove::ParameterStore& store, Run run);

  /// Hands the requests since the last call to the store's thread, which answers them.
  void serve();

 private:
  using Answer = std::string (*)(protocol::foxglove::ParameterStore& store, std::string_view request);
  /// Service with its topics, and the function that makes a reply; the reply is empty for a broken request.
  struct Service {
    std::unique_ptr<Reader> requests{};
    std::shared_ptr<Writer> replies{};
    Answer answer = nullptr;
  };

  ParameterServices(protocol::foxglove::ParameterStore& store, Run run)
      : store_{store}, run_{std::move(run)} {}

  protocol::foxglove::ParameterStore& store_;
  Run run_;  ///< runs a task on the store's thread
  std::vector<Service> services_;
};

}  // namespace chicane::ros
