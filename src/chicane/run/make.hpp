// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>

#include "chicane/base/result.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/path/track.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/sim/plant.hpp"

namespace chicane::run {

/// The parts of an experiment, built from its description. Each fails with the key and value that is wrong.
[[nodiscard]] Result<std::unique_ptr<controller::Controller>> make_controller(
    const scenario::Scenario& scenario);
/// The car that its controller believes in: a model car in full size (model/similarity.hpp).
[[nodiscard]] model::VehicleParams full_size(const scenario::Scenario& scenario);
/// Makes the controller of a run, for the car in full_size(): make_controller, or a program's own.
using ControllerFactory =
    std::function<Result<std::unique_ptr<controller::Controller>>(const scenario::Scenario&)>;
/// Gives a controller of make_controller() the scenario's settings while it drives (controller/tunable.hpp).
void configure(controller::Controller& controller, const scenario::Scenario& scenario) noexcept;
[[nodiscard]] Result<std::unique_ptr<sim::Plant>> make_plant(const scenario::Scenario& scenario);
[[nodiscard]] Result<path::Track> make_track(const scenario::Scenario& scenario);

/// The road as telemetry shows it: the track's own points where they are spaced like waypoints, every
/// so-many-th of them where they are denser (surveyed tracks have one each 5 m or less, and six of those show
/// nothing of the road).
/// `scale`: of the car.
[[nodiscard]] Result<path::Track> make_waypoints(const path::Track& track, double scale = 1.0);

}  // namespace chicane::run
