// SPDX-License-Identifier: MIT
// Live run whose car another program simulates, and other futures of it by a plant of ours.
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
#include "chicane/scenario/scenario.hpp"
#include "chicane/wire/serve.hpp"

namespace chicane::live {

/// Function that serves the car of another program until it is stopped: wire::serve, or ros::drive
/// (ros/nodes.hpp). All hooks except `log` are called on one thread.
using ServeFunction = std::function<Result<wire::ServeSummary>(
    const wire::ServeOptions&, std::unique_ptr<controller::Controller>, wire::ServeHooks, wire::Endpoint*,
    std::vector<net::Asset>, const std::atomic<bool>&)>;

/// Run of our controller with a car that another program simulates: the server for the simulator, viewers,
/// recording, limit and settings, and the data that threads exchange; as LiveRun with our simulator.
class ServedRun {
 public:
  /// `track`: road of the simulator; with it there is a limit. `assets`: files of the dashboard. `lap`:
  /// planned lap of a controller that races (run/racing.hpp), or null.
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
  /// thread. May be called once. kIo if the port is taken, with the remedy.
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

/// Sighting of a car that another program simulates.
struct Seen {
  double time = 0.0;                                ///< [s]
  double delay = 0.0;                               ///< delay from the measurement to the actuators [s]
  double x = 0.0, y = 0.0, psi = 0.0, speed = 0.0;  ///< pose in W [m, rad], speed [m/s]
  model::Command sent;                              ///< command that answered the measurement
};
/// State of the car at `seen[i]`; sideslip and yaw rate follow from the sighting before. Pre: i > 0.
[[nodiscard]] model::State moving(const std::vector<Seen>& seen, std::size_t i);

/// Two futures of a run whose car another program simulates. Both are driven by a plant of ours in place of
/// that car, on the known road, from the car's place. Before that, our controller repeats the minutes before
/// the moment, which restores what it has learned and the commands in flight. The error of the plant is
/// measured: it also drives the ten seconds before the moment, and is compared with the external car.
class ServedFutures {
 public:
  static constexpr double kFollowed =
      150.0;  ///< longest stretch before the moment that is repeated [s]; chosen
  static constexpr double kCompared = 10.0;  ///< duration of the comparison with the external car [s]; chosen

  /// `log` outlives this.
  explicit ServedFutures(RunLog& log) : log_{log} {}

  /// Sets the current settings; the scenario's track is the road of the simulator. Any thread.
  void assume(const scenario::Scenario& scenario);
  /// Refuses all futures from now on, with the reason `why`: the road is not the simulator's. Any thread.
  void give_up(std::string why);

  /// Drives both futures from `options.at` on: with the current settings, and with those in `options`. Fails
  /// as recording::branch_run() does, and if less than a second is known. One thread at a time.
  [[nodiscard]] Result<recording::BranchReport> branch(const recording::BranchOptions& options,
                                                       const recording::BranchHooks& hooks);

 private:
  /// Record of the external car around a moment.
  struct Known {
    std::vector<Seen> seen;  ///< sightings of the newest car, without gaps
    std::size_t at = 0;      ///< index of the last sighting up to the moment
  };
  /// Record around `time` [s]. Fails if less than a second before it is known.
  [[nodiscard]] Result<Known> known_at(double time);
  /// Begins `car` as a run of our plant that repeats the sightings up to `seen[to]`, and continues from
  /// there.
  [[nodiscard]] Result<void> follow(recording::ShadowRun& car, scenario::Scenario scenario,
                                    const std::vector<Seen>& seen, std::size_t to);
  /// Drives our plant over the last kCompared before the moment, and measures its distance from the car.
  [[nodiscard]] Result<recording::StandIn> compare(const scenario::Scenario& scenario, const Known& known,
                                                   const recording::BranchHooks& hooks);

  RunLog& log_;
  run::Roads roads_;                            ///< roads of the futures, made once
  std::mutex mutex_;                            ///< guards all below
  std::optional<scenario::Scenario> scenario_;  ///< current settings; none: the road is unknown
  std::string why_not_;                         ///< reason of give_up(); empty: none
};

}  // namespace chicane::live
