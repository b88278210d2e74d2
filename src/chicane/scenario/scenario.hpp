// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "chicane/controller/baselines.hpp"
#include "chicane/controller/cubic_mpc.hpp"
#include "chicane/controller/tracking_mpc.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/sim/fault.hpp"
#include "chicane/sim/sensor.hpp"

namespace chicane::scenario {

/// Deviations of the simulated world from its nominal state.
struct PlantOptions {
  double friction_scale = 1.0;  ///< tyre forces times this; (0, 2]
  double mass_scale = 1.0;      ///< [0.5, 2]
};

/// One experiment as plain data; everything a preset, scenario file or --set can change. Defaults are preset
/// `default`. Units inside are SI; files and the command line use suffixed names (protocol/schema.hpp has the
/// one table).
struct Scenario {
  std::string preset = "default";
  std::string track = "lakeside";           ///< name of a shipped track, or a file
  std::string car = "udacity";              ///< name of a shipped car, or a file
  std::string plant = "udacity";            ///< "udacity" or "road-car"; set by the car
  std::string controller = "tracking-mpc";  ///< tracking-mpc | cubic-mpc | pid | pure-pursuit | stanley

  int laps = 3;  ///< [0, 10000]; the first is from standstill; 0 = until stopped
  std::uint64_t seed = 1;
  double latency = 0.1;          ///< actuation delay of the plant [s]; [0, 0.5]
  double control_period = 0.04;  ///< between measurements [s]; [0.005, 1]
  double time_limit = 0.0;       ///< ends the run [s]; 0 = 10 min per lap
  double turn_around =
      0.02;                ///< of the simulator as a client, between reply and next telemetry [s]; [0, 0.5]
  int waypoints_sent = 6;  ///< telemetry shows this many waypoints; [2, 32]

  model::VehicleParams vehicle;  ///< what the controller believes
  PlantOptions plant_options;
  sim::SensorOptions sensor;
  std::vector<sim::FaultEvent> faults;  ///< that happen during the run; at most sim::FaultLab::kCapacity

  controller::TrackingMpcOptions tracking_mpc;
  controller::CubicMpcOptions cubic_mpc;
  controller::PidOptions pid;
  controller::PurePursuitOptions pure_pursuit;
  controller::StanleyOptions stanley;
};

}  // namespace chicane::scenario
