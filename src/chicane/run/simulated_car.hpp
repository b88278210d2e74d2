// SPDX-License-Identifier: MIT
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

/// A simulated car on its road, for a controller in this program or in another one: the plant and its world,
/// the sensor, commands on their way, the receiver that stops the car when none come (`simulate` has one of
/// its own), and the account of the run. No allocation but in create(), restart() and a copy. One thread.
struct SimulatedCar {
  static constexpr double kCatchUp = 1.0 / 3.0;  ///< most physics that is caught up with in a call [s]

  SimulatedCar(const scenario::Scenario& scenario, road::Track road, road::Track shown,
               std::unique_ptr<sim::Plant> car, AccountTerms terms);
  /// Copies plant and road. Without a plant if that cannot be copied (sim/plant.hpp).
  SimulatedCar(const SimulatedCar& other);
  SimulatedCar& operator=(const SimulatedCar&) = delete;
  ~SimulatedCar() = default;
  /// The car of a scenario for a controller that is another program: no guard, no deadline, and no latency in
  /// its account but `latency` [s]. Fails as run/make.hpp does.
  [[nodiscard]] static Result<std::unique_ptr<SimulatedCar>> create(const scenario::Scenario& scenario,
                                                                    double latency);

  /// Starts another run from the start of the road.
  void restart(const scenario::Scenario& scenario);
  /// One physics step with the command that acts.
  void advance(const model::Command& command, bool is_manual = false) noexcept;
  /// Physics up to `time` [s] or the end of the run; `act` gives the command of each step. Returns the time
  /// [s] beyond kCatchUp by which they were late: it is left out, and the run's clock has to go back by it.
  [[nodiscard]] double catch_up(double time, const std::function<model::Command()>& act);
  /// Telemetry now, with as many waypoints at most.
  [[nodiscard]] model::Measurement sense(int waypoint_count) noexcept;
  /// Writes a measurement, the command that acted then, and the world's state into the frame of a controller
  /// in another program.
  void write(const model::Measurement& seen, const model::Command& applied,
             telemetry::Frame& frame) const noexcept;
  /// Counts a cycle of a controller that is another program, whose answer is `frame.result.command`.
  void count(telemetry::Frame& frame) noexcept;
  /// Wheel speed [m/s].
  [[nodiscard]] double speed() const noexcept { return plant->output().speed; }

  road::Track track, waypoints;
  Owned<sim::Plant> plant;
  sim::World world;  ///< stands on plant and track
  sim::Sensor sensor;
  sim::ActuationDelay in_flight{};
  safety::StopPlayer receiver;
  Account account;
};

/// Says that a car is stopped because no commands come, that it stands, and that commands come again.
class StopNews {
 public:
  using Say = std::function<void(std::string_view)>;
  StopNews(const scenario::Scenario& scenario, Say say);

  /// Reports stops; call it after physics that began at `speed` [m/s]. `is_timed_out`: the receiver stops the
  /// car. `why` gives the reason, a clause. True when a stop began.
  bool look(const SimulatedCar& car, bool is_timed_out, double speed,
            const std::function<std::string()>& why);

 private:
  const double standing_;  ///< [m/s]
  Say say_;
  bool is_timed_out_ = false;  ///< timed out at the last look
  bool is_said_ = false;       ///< the current stop was reported
  bool is_moving_ = false;     ///< the car moves during that stop
};

/// Writes a judge's findings into a frame: place, laps. The rest stays.
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

/// Writes the world's state into a frame: truth, accelerations, place, laps. The rest stays.
inline void observe(const sim::World& world, telemetry::Frame& frame) noexcept {
  frame.truth = world.plant().state();
  frame.has_truth = true;
  frame.lateral_acceleration = world.plant().output().ay;
  frame.longitudinal_acceleration = world.plant().output().ax;
  frame.tire_use = world.plant().output().tire_use;
  observe(world.state(), frame);
}

}  // namespace chicane::run
