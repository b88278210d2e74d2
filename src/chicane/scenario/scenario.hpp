// SPDX-License-Identifier: MIT
// Scenario: one experiment as plain data, which presets, files, the command line and viewers change.
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

/// One experiment: track, car, controller, simulated world and faults. The defaults are those of the preset
/// `default`. Units are SI; files and the command line use names with units, whose ranges protocol/schema.hpp
/// lists.
struct Scenario {
  std::string preset = "default";
  std::string track = "lakeside";  ///< name of a shipped track, or a file
  double track_scale = 0.0;        ///< size of a shipped track over the size in its file; 0: the car's scale
  std::string car = "udacity";     ///< name of a shipped car, or a file
  std::string plant = "udacity";   ///< one of sim::plants(); set by the car
  std::string controller = "tracking-mpc";  ///< one of controller::Registry

  int laps = 3;                  ///< number of laps, the first from standstill; 0: until stopped
  std::uint64_t seed = 1;        ///< seed of all random numbers
  double latency = 0.1;          ///< actuation delay of the plant [s]
  double latency_jitter = 0.0;   ///< largest random addition to `latency`, unknown to the controller [s]
  double control_period = 0.04;  ///< time between measurements [s]
  double time_limit = 0.0;       ///< longest time of the run [s]; 0: 10 min for each lap
  double turn_around = 0.02;     ///< time between reply and next telemetry of a simulator as client [s]
  int waypoints_sent = 6;        ///< number of waypoints in a measurement

  model::VehicleParams vehicle = model::udacity_params();  ///< controller's model of the car
  /// Largest friction that the plan of a race assumes; 0: not known; infinite: vehicle.friction.
  double friction_low = std::numeric_limits<double>::infinity();
  safety::GuardOptions guard;           ///< guard over the controller
  sim::DoubleTrackParams plant_params;  ///< plant `double-track`, from which `vehicle` follows
  sim::PlantDeviation plant_options;    ///< differences of the plant to its nominal parameters
  sim::SensorOptions sensor;            ///< errors of the measurements
  std::vector<sim::FaultEvent> faults;  ///< faults during the run; at most sim::FaultLab::kCapacity

  /// Sentences for the user about assumptions of protocol::compose() and settings without effect. No setting.
  std::vector<std::string> notices;

  /// Size of the road over the size in its file.
  [[nodiscard]] double size_of_track() const noexcept {
    return track_scale > 0.0 ? track_scale : vehicle.scale;
  }
  /// Scale of sizes that a reader of track files assumes, such as noise: that of the car for a road in its
  /// own size, else full size.
  [[nodiscard]] double scale_of_file() const noexcept { return track_scale == 1.0 ? vehicle.scale : 1.0; }

  /// Whether the controller races by a planned lap at the limit of the car.
  [[nodiscard]] bool races() const noexcept {
    using Entry = controller::TrackingMpcEntry;
    return controller == Entry::kName && std::get<Entry::Options>(controllers).racing_line;
  }
  /// Car that controller and planner assume: a race has at most friction_low.
  [[nodiscard]] model::VehicleParams assumed_vehicle() const {
    model::VehicleParams assumed = vehicle;
    if (races() && friction_low < assumed.friction) assumed.friction = friction_low;
    return assumed;
  }

  /// Options of all controllers, whichever drives; read by std::get<controller::PidOptions>(controllers).
  controller::Registry::Options controllers;
};

}  // namespace chicane::scenario
