// SPDX-License-Identifier: MIT
// Simulated car with everything between its plant and a controller: sensor, delay, receiver and account.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "chicane/base/owned.hpp"
#include "chicane/base/result.hpp"
#include "chicane/model/state.hpp"
#include "chicane/road/track.hpp"
#include "chicane/run/account.hpp"
#include "chicane/safety/stop_player.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/sim/plant.hpp"
#include "chicane/sim/sensor.hpp"
#include "chicane/sim/world.hpp"
#include "chicane/telemetry/frame.hpp"

namespace chicane::run {

/// Simulated car on its road, for a controller in this program or in another one: plant and world, sensor,
/// commands in flight, the receiver that stops the car when no commands come (`simulate` has another one),
/// and the account of the run. Allocates in create(), restart() and copies only. One thread.
struct SimulatedCar {
  static constexpr double kCatchUp = 1.0 / 3.0;  ///< most run time that one catch_up() computes [s]; chosen

  SimulatedCar(const scenario::Scenario& scenario, road::Track road, road::Track shown,
               std::unique_ptr<sim::Plant> car, AccountTerms terms);
  /// Copies plant and road. The copy has no plant if the plant cannot be copied (sim/plant.hpp).
  SimulatedCar(const SimulatedCar& other);
  SimulatedCar& operator=(const SimulatedCar&) = delete;
  ~SimulatedCar() = default;
  /// Creates the car of a scenario for a controller in another program: its account has no guard, no
  /// deadline, and `latency` [s] in place of the scenario's. Fails as run/make.hpp does.
  [[nodiscard]] static Result<std::unique_ptr<SimulatedCar>> create(const scenario::Scenario& scenario,
                                                                    double latency);

  /// Starts another run from the start of the road.
  void restart(const scenario::Scenario& scenario);
  /// One physics step with the command that acts. `is_manual`: a person drives.
  void advance(const model::Command& command, bool is_manual = false) noexcept;
  /// Physics up to `time` [s] or the end of the run; `act` gives the command of each step. Computes at most
  /// kCatchUp, and returns the time beyond it [s], which is skipped: the caller sets its clock back by it.
  [[nodiscard]] double catch_up(double time, const std::function<model::Command()>& act);
  /// Measurement of the sensor now, with at most `waypoint_count` waypoints.
  [[nodiscard]] model::Measurement sense(int waypoint_count) noexcept;
  /// Writes a measurement, the command that acted then, and the world's state into the frame of a cycle whose
  /// controller is another program.
  void write(const model::Measurement& seen, const model::Command& applied,
             telemetry::Frame& frame) const noexcept;
  /// Counts a cycle whose controller is another program; its answer is `frame.result.command`.
  void count(telemetry::Frame& frame) noexcept;
  /// Wheel speed [m/s].
  [[nodiscard]] double speed() const noexcept { return plant->output().speed; }

  road::Track track, waypoints;     ///< road, and its waypoints as telemetry shows them
  Owned<sim::Plant> plant;          ///< the car's motion
  sim::World world;                 ///< judge of the car; refers to plant and track
  sim::Sensor sensor;               ///< measurement with age and noise
  sim::ActuationDelay in_flight{};  ///< commands that do not act yet
  safety::StopPlayer receiver;      ///< stops the car when no commands come
  Account account;                  ///< laps, metrics and end of the run
};

/// Reports for people that a car is stopped because no commands come, that it stands, and that commands come
/// again.
class StopNews {
 public:
  using Say = std::function<void(std::string_view)>;
  StopNews(const scenario::Scenario& scenario, Say say);

  /// Reports changes; call it after physics steps that began at `speed` [m/s]. `is_timed_out`: the receiver
  /// stops the car. `why` gives the reason, a clause. True when a stop began.
  bool look(const SimulatedCar& car, bool is_timed_out, double speed,
            const std::function<std::string()>& why);

 private:
  static constexpr double kStanding = 0.1;  ///< speed below which a car in full size stands [m/s]; chosen

  const double standing_;      ///< speed below which this car stands [m/s]
  Say say_;                    ///< gets the lines
  bool is_timed_out_ = false;  ///< `is_timed_out` of the last call
  bool is_said_ = false;       ///< the current stop was reported
  bool is_moving_ = false;     ///< the car still moves in the current stop
};

/// Writes place and laps by a judge into a frame; other fields stay.
inline void observe(const sim::WorldState& state, telemetry::Frame& frame) noexcept {
  frame.is_judged = true;
  frame.s = state.s;
  frame.lateral_error = state.lateral_error;
  frame.heading_error = state.heading_error;
  frame.edge_distance = state.edge_distance;
  frame.is_off_track = state.is_off_track;
  frame.lap = state.lap;
  frame.lap_time = state.lap_time;
  frame.last_lap_time = state.last_lap_time;
  frame.off_track_events = state.off_track_events;
}

/// Writes truth, accelerations, place and laps of the world into a frame; other fields stay.
inline void observe(const sim::World& world, telemetry::Frame& frame) noexcept {
  frame.truth = world.plant().state();
  frame.has_truth = true;
  frame.lateral_acceleration = world.plant().output().ay;
  frame.longitudinal_acceleration = world.plant().output().ax;
  frame.tire_use = world.plant().output().tire_use;
  observe(world.state(), frame);
}

}  // namespace chicane::run
