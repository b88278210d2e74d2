// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "chicane/controller/registry.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/safety/guard_options.hpp"
#include "chicane/sim/double_track.hpp"
#include "chicane/sim/fault.hpp"
#include "chicane/sim/plant.hpp"
#include "chicane/sim/sensor.hpp"

namespace chicane::scenario {

/// One experiment as plain data; everything a preset, scenario file or --set can change. Defaults are preset
/// `default`. Units inside are SI; files and the command line use suffixed names, whose ranges
/// protocol/schema.hpp lists.
struct Scenario {
  std::string preset = "default";
  std::string track = "lakeside";           ///< name of a shipped track, or a file
  double track_scale = 0.0;                 ///< size of a shipped track over its file's; 0: the car's scale
  std::string car = "udacity";              ///< name of a shipped car, or a file
  std::string plant = "udacity";            ///< one of sim::plants(); set by the car
  std::string controller = "tracking-mpc";  ///< one of controller::Registry

  int laps = 3;  ///< the first is from standstill; 0 = until stopped
  std::uint64_t seed = 1;
  double latency = 0.1;          ///< actuation delay of the plant [s]
  double latency_jitter = 0.0;   ///< random delay on top, unknown to the controller, at most [s]
  double control_period = 0.04;  ///< time between measurements [s]
  double time_limit = 0.0;       ///< ends the run [s]; 0 = 10 min per lap
  double turn_around = 0.02;     ///< time between reply and next telemetry of a simulator as client [s]
  int waypoints_sent = 6;        ///< telemetry shows this many waypoints

  model::VehicleParams vehicle = model::udacity_params();  ///< the controller's model of it
  double friction_low =
      std::numeric_limits<double>::infinity();  ///< least known friction of the car, for the plan of a race;
                                                ///< 0: not known; infinite: vehicle.friction
  safety::GuardOptions guard;                   ///< guard over the controller
  sim::DoubleTrackParams plant_params;  ///< for the plant `double-track`, whose model follows from them
  sim::PlantDeviation plant_options;
  sim::SensorOptions sensor;
  std::vector<sim::FaultEvent> faults;  ///< faults during the run; at most sim::FaultLab::kCapacity

  /// Assumptions made by compose(), and settings without effect: a sentence each, for the terminal, JSON and
  /// the dashboard alike. No setting.
  std::vector<std::string> notices;

  [[nodiscard]] double size_of_track() const noexcept {
    return track_scale > 0.0 ? track_scale : vehicle.scale;
  }
  /// Scale of assumed sizes in a track's file: a road driven in its own size has the noise of the car's size,
  /// any other one is in full size.
  [[nodiscard]] double scale_of_file() const noexcept { return track_scale == 1.0 ? vehicle.scale : 1.0; }

  /// Whether a planned lap at the car's limit is driven by.
  [[nodiscard]] bool races() const noexcept {
    using Entry = controller::TrackingMpcEntry;
    return controller == Entry::kName && std::get<Entry::Options>(controllers).racing_line;
  }
  /// The car that controller and planner assume: a race is planned with no more friction than is known.
  [[nodiscard]] model::VehicleParams assumed_vehicle() const {
    model::VehicleParams assumed = vehicle;
    if (races() && friction_low < assumed.friction) assumed.friction = friction_low;
    return assumed;
  }

  /// Options of all controllers, whichever drives: std::get<controller::PidOptions>(controllers).
  controller::Registry::Options controllers;
};

}  // namespace chicane::scenario
