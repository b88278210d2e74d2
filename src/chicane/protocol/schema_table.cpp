// SPDX-License-Identifier: MIT
#include <array>
#include <deque>
#include <string>

#include "chicane/protocol/schema.hpp"
#include "chicane/sim/plant_registry.hpp"

namespace chicane::protocol {
namespace {

using scenario::Scenario;
using S = Scenario;

/// The run itself.
auto run_options() {
  return std::array{
      option<&S::preset>("preset", "Named controller settings this run starts from."),
      option<&S::track>("track", "Shipped track by name, or a file."),
      option<&S::track_scale>(
          "track_scale", unit::kNone, 0, 10,
          "Size of the track over that of its file; 0 is the car's scale: 1 but for model cars."),
      option<&S::car>("car", "Shipped car by name, or a file."),
      option<&S::plant>("plant", sim::plant_names(), "Simulated car; normally set by the car file."),
      option<&S::controller>("controller", controller::Registry::kNames,
                             "Name of the controller that drives."),
      option<&S::laps>("laps", unit::kNone, 0, 10000,
                       "Laps to drive, the first from standstill; 0 drives until stopped."),
      option<&S::seed>("seed", unit::kNone, 0, 9007199254740992.0, "Seed of everything random."),
      option<&S::latency>("latency", unit::kMillisecond, 0, 500, "Actuation delay of the simulated car."),
      option<&S::latency_jitter>(
          "latency_jitter", unit::kMillisecond, 0, 500,
          "Random delay of each command on top, evenly distributed from 0 to this; the "
          "controller is not told."),
      option<&S::friction_low>(
          "friction_low", unit::kNone, 0, 5,
          "Friction that the car is known to have at least, which a race is planned with; 0 where it is not "
          "known: no race; infinite: vehicle.friction.")
          .or_infinite(),
      option<&S::control_period>("control_period", unit::kMillisecond, 5, 1000, "Time between measurements."),
      option<&S::time_limit>("time_limit", unit::kSecond, 0, 1e7,
                             "Ends the run; 0 allows ten minutes per lap."),
      option<&S::turn_around>("turn_around", unit::kMillisecond, 0, 500,
                              "Pause of the simulator as a client, from reply to next telemetry."),
      option<&S::waypoints_sent>("waypoints_sent", unit::kNone, 2, 32, "Waypoints the telemetry shows."),
  };
}

/// All rows, and the keys they point to.
struct Table {
  std::deque<std::string> keys;
  std::vector<Parameter> rows;

  void add(std::string_view group, std::string_view of_controller, std::span<const Option> options,
           void* (*owner)(Scenario&)) {
    for (const Option& option : options) {
      keys.push_back(option_key(group, option));
      rows.push_back({keys.back(), group, of_controller, option, owner});
    }
  }
};

Table make_table() {
  Table table;
  table.add("", "", run_options(), [](Scenario& s) -> void* { return &s; });
  controller::Registry::for_each([&]<class Entry>() {
    table.add(controller::kOptionGroup<Entry>, Entry::kName, Entry::options(),
              [](Scenario& s) -> void* { return &std::get<typename Entry::Options>(s.controllers); });
  });
  table.add("vehicle", "", model::vehicle_options(), [](Scenario& s) -> void* { return &s.vehicle; });
  table.add("plant_params", "", sim::double_track_options(),
            [](Scenario& s) -> void* { return &s.plant_params; });
  table.add("guard", "", safety::guard_options(), [](Scenario& s) -> void* { return &s.guard; });
  table.add("identify", "", safety::identify_options(), [](Scenario& s) -> void* { return &s.identify; });
  table.add("plant_options", "", sim::deviation_options(),
            [](Scenario& s) -> void* { return &s.plant_options; });
  table.add("sensor", "", sim::sensor_options(), [](Scenario& s) -> void* { return &s.sensor; });
  return table;
}

}  // namespace

std::span<const Parameter> list() {
  static const Table kTable = make_table();
  return kTable.rows;
}

}  // namespace chicane::protocol
