// SPDX-License-Identifier: MIT
// Factories: controller, plant, track and waypoints of a run from its scenario.
#pragma once

#include <concepts>
#include <functional>
#include <memory>
#include <utility>

#include "chicane/base/result.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/road/track.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/sim/plant.hpp"

namespace chicane::run {

/// Makes the controller that a scenario names. Fails with the key and value that is wrong.
[[nodiscard]] Result<std::unique_ptr<controller::Controller>> make_controller(
    const scenario::Scenario& scenario);
/// Car that the scenario's controller assumes, with a model car scaled to full size (model/vehicle.hpp).
[[nodiscard]] model::VehicleParams full_size(const scenario::Scenario& scenario);
/// Makes the plant that a scenario names. Fails with the key and value that is wrong.
[[nodiscard]] Result<std::unique_ptr<sim::Plant>> make_plant(const scenario::Scenario& scenario);
/// Reads the track that a scenario names, in the size of the scenario's car. Fails as protocol::read_track().
[[nodiscard]] Result<road::Track> make_track(const scenario::Scenario& scenario);

/// Makes the controller of a run, for the car in full_size().
using ControllerFactory =
    std::function<Result<std::unique_ptr<controller::Controller>>(const scenario::Scenario&)>;
/// Makes the simulated car of a run.
using PlantFactory = std::function<Result<std::unique_ptr<sim::Plant>>(const scenario::Scenario&)>;
/// Makes the road of a run, in the size scenario.size_of_track().
using TrackFactory = std::function<Result<road::Track>(const scenario::Scenario&)>;

/// Factories of the parts of a run: by default those that the scenario names. A program's own factory
/// replaces one of them. It must make the same part for the same scenario, and must not be empty. Recordings
/// keep the names in the scenario.
struct Factories {
  Factories() = default;
  /// Factories with the program's own controller, in the scenario's car and on its road.
  template <class Factory>
  requires std::convertible_to<Factory, ControllerFactory> Factories(Factory own)
      : controller{std::move(own)} {}  // NOLINT(google-explicit-constructor): one part is enough

  ControllerFactory controller = make_controller;
  PlantFactory plant = make_plant;
  TrackFactory track = make_track;
};

/// Road as telemetry shows it: the track's points, thinned if they are denser than waypoints. Surveyed tracks
/// have a point each 5 m or less, of which the six sent ones show too little of the road. `scale`:
/// VehicleParams::scale.
[[nodiscard]] Result<road::Track> make_waypoints(const road::Track& track, double scale = 1.0);

}  // namespace chicane::run
