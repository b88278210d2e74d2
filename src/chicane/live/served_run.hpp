// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/live/run_publisher.hpp"
#include "chicane/protocol/ros_messages.hpp"
#include "chicane/recording/recorder.hpp"
#include "chicane/road/track.hpp"
#include "chicane/run/setting.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/wire/serve.hpp"

namespace chicane::live {

/// Serves a car of another simulator until it is stopped: wire::serve, or the same in another dialect
/// (ros/drive_node.hpp). The hooks are called on one thread, but for `log`.
using ServeFunction = std::function<Result<wire::ServeSummary>(
    const wire::ServeOptions&, std::unique_ptr<controller::Controller>, wire::ServeHooks, wire::Endpoint*,
    std::vector<net::Asset>, const std::atomic<bool>&)>;

/// A run in which the car is simulated by another program and the controller is ours: the endpoint for the
/// simulator, viewers, recording, limit and settings, and what each thread hands to which, as LiveRun does
/// for a run with our simulator.
class ServedRun {
 public:
  /// `track`: the road that the simulator drives on, where it is known: laps are timed, and there is a limit.
  /// `assets`: files of the dashboard. `lap`: planned, of a controller that races (run/racing.hpp).
  ServedRun(const net::ServerOptions& server, const scenario::Scenario& scenario,
            std::unique_ptr<controller::Controller> controller, std::optional<road::Track> track,
            std::vector<net::Asset> assets = {}, std::shared_ptr<const road::RacingRoad> lap = nullptr);
  ServedRun(const ServedRun&) = delete;
  ServedRun& operator=(const ServedRun&) = delete;

  /// The run, for a recording.
  [[nodiscard]] const protocol::Run& description() const { return description_; }
  /// Deadline of each control step [s]; 0: none.
  [[nodiscard]] double step_budget() const;

  /// Answers simulators until `stop`. `recorder` may be null; `on_listening` hears the port once, on this
  /// thread. Once per object. kIo with the sentence that helps when the port is taken.
  [[nodiscard]] Result<wire::ServeSummary> run(recording::Recorder* recorder, const LiveHooks& hooks,
                                               const std::function<void(std::uint16_t)>& on_listening,
                                               const std::atomic<bool>& stop,
                                               const ServeFunction& serve = wire::serve);

 private:
  scenario::Scenario scenario_;
  std::unique_ptr<controller::Controller> controller_;
  std::optional<road::Track> track_;
  protocol::Run description_;
  wire::ServeOptions options_;
  std::vector<net::Asset> assets_;
};

}  // namespace chicane::live
