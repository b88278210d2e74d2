// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/live/run_log.hpp"
#include "chicane/live/run_publisher.hpp"
#include "chicane/model/state.hpp"
#include "chicane/protocol/ros_messages.hpp"
#include "chicane/recording/recorder.hpp"
#include "chicane/recording/shadow_run.hpp"
#include "chicane/road/track.hpp"
#include "chicane/run/roads.hpp"
#include "chicane/run/setting.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/wire/serve.hpp"

namespace chicane::live {

/// Serves a car of another simulator until it is stopped: wire::serve, or the same in another dialect
/// (ros/nodes.hpp). The hooks are called on one thread, but for `log`.
using ServeFunction = std::function<Result<wire::ServeSummary>(
    const wire::ServeOptions&, std::unique_ptr<controller::Controller>, wire::ServeHooks, wire::Endpoint*,
    std::vector<net::Asset>, const std::atomic<bool>&)>;

/// A run in which the car is simulated by another program and the controller is ours: the endpoint for the
/// simulator, viewers, recording, limit and settings, and the data that threads exchange, as in LiveRun for
/// our simulator.
class ServedRun {
 public:
  /// `track`: the simulator's road, if it is known: laps are timed, and there is a limit. `assets`: files of
  /// the dashboard. `lap`: planned, of a controller that races (run/racing.hpp).
  ServedRun(const net::ServerOptions& server, const scenario::Scenario& scenario,
            std::unique_ptr<controller::Controller> controller, std::optional<road::Track> track,
            std::vector<net::Asset> assets = {}, std::shared_ptr<const road::RacingRoad> lap = nullptr);
  ServedRun(const ServedRun&) = delete;
  ServedRun& operator=(const ServedRun&) = delete;

  /// Description of the run, for a recording.
  [[nodiscard]] const protocol::Run& description() const { return description_; }
  /// Deadline of each control step [s]; 0: none.
  [[nodiscard]] double step_budget() const;

  /// Answers simulators until `stop`. `recorder` may be null; `on_listening` gets the port once, on this
  /// thread. Once per object. kIo if the port is taken, with the remedy.
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

/// Measured moment of a car that another program simulates.
struct Seen {
  double time = 0.0;   ///< [s]
  double delay = 0.0;  ///< delay from the measurement to the actuators [s]
  double x = 0.0, y = 0.0, psi = 0.0, speed = 0.0;
  model::Command sent;
};
/// Motion of the car at `seen[i]`; sideslip and yaw rate are computed from the sighting before. Pre: i > 0.
[[nodiscard]] model::State moving(const std::vector<Seen>& seen, std::size_t i);

/// Futures of a run whose car another program simulates: both are driven by our own simulator of that car, on
/// the known road, from the car's place. Our controller sees the minutes before again, to restore its state:
/// the learned road, and the commands in flight. The accuracy of our simulator is measured: it drives the ten
/// seconds before the moment, too, and is compared with the external car.
class ServedFutures {
 public:
  static constexpr double kFollowed = 150.0;  ///< length of the run before the moment [s]
  static constexpr double kCompared = 10.0;   ///< [s]

  /// `log` must outlive it.
  explicit ServedFutures(RunLog& log) : log_{log} {}

  /// Sets the settings that hold from now on; the scenario's track is the simulator's road. Any thread.
  void assume(const scenario::Scenario& scenario);
  /// Stops all futures: the road is not the simulator's; branch() gives `why` from now on. Any thread.
  void give_up(std::string why);

  /// Drives both futures from `options.at` on: with the current settings, and with those in `options`. Fails
  /// as recording::branch_run() does, and if less than a second is known. One thread at a time.
  [[nodiscard]] Result<recording::BranchReport> branch(const recording::BranchOptions& options,
                                                       const recording::BranchHooks& hooks);

 private:
  struct Known {
    std::vector<Seen> seen;  ///< sightings of the newest car
    std::size_t at = 0;      ///< index of the moment
  };
  [[nodiscard]] Result<Known> known_at(double time);
  [[nodiscard]] Result<void> follow(recording::ShadowRun& car, scenario::Scenario scenario,
                                    const std::vector<Seen>& seen, std::size_t to);

  RunLog& log_;
  run::Roads roads_;
  std::mutex mutex_;  ///< guards all below
  std::optional<scenario::Scenario> scenario_;
  std::string why_not_;
};

}  // namespace chicane::live
