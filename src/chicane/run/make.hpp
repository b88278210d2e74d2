// SPDX-License-Identifier: MIT
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

/// The parts of an experiment, built from its description. Each fails with the key and value that is wrong.
[[nodiscard]] Result<std::unique_ptr<controller::Controller>> make_controller(
    const scenario::Scenario& scenario);
/// The car that its controller assumes: a model car in full size (model/vehicle.hpp).
[[nodiscard]] model::VehicleParams full_size(const scenario::Scenario& scenario);
[[nodiscard]] Result<std::unique_ptr<sim::Plant>> make_plant(const scenario::Scenario& scenario);
[[nodiscard]] Result<road::Track> make_track(const scenario::Scenario& scenario);

/// Makes the controller of a run, for the car in full_size().
using ControllerFactory =
    std::function<Result<std::unique_ptr<controller::Controller>>(const scenario::Scenario&)>;
/// Makes the simulated car of a run.
using PlantFactory = std::function<Result<std::unique_ptr<sim::Plant>>(const scenario::Scenario&)>;
/// Makes the road of a run, for a car of the size that scenario.size_of_track() says.
using TrackFactory = std::function<Result<road::Track>(const scenario::Scenario&)>;

/// Makes the parts of a run: as the scenario names them, or a program's own. A factory of the program's own
/// is called instead of the named part and must do the same in every call with the same scenario. Functions
/// must not be empty. The scenario keeps its names: recordings have its `plant` and `track`, too.
struct Factories {
  Factories() = default;
  /// A controller of the program's own, in the scenario's car, on its road.
  template <class Factory>
  requires std::convertible_to<Factory, ControllerFactory> Factories(Factory own)
      : controller{std::move(own)} {}  // NOLINT(google-explicit-constructor): one part is enough

  ControllerFactory controller = make_controller;
  PlantFactory plant = make_plant;
  TrackFactory track = make_track;
};

/// The road as telemetry shows it: the track's own points where they are spaced like waypoints, every
/// so-many-th of them where they are denser (surveyed tracks have one each 5 m or less, and six of those show
/// nothing of the road).
/// `scale`: of the car.
[[nodiscard]] Result<road::Track> make_waypoints(const road::Track& track, double scale = 1.0);

}  // namespace chicane::run
