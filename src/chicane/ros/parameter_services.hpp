// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/protocol/foxglove_codec.hpp"
#include "chicane/ros/dds.hpp"

namespace chicane::ros {

/// The parameter services of the node /chicane: list_parameters, get_parameters, set_parameters and
/// describe_parameters, for clients that use rmw_cyclonedds. A setting takes effect at the next control step,
/// as one of a viewer does.
class ParameterServices {
 public:
  /// Runs a task on the thread to which the store belongs.
  using Run = std::function<void(std::function<void()>)>;

  /// `store` outlives the tasks. kIo when DDS refuses.
  [[nodiscard]] static Result<std::unique_ptr<ParameterServices>> create(
      Participant& participant, protocol::foxglove::ParameterStore& store, Run run);

  /// Hands what was asked since the last call to the store's thread, which answers.
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
