// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/sim/plant.hpp"

namespace chicane::sim {

/// How a plant differs from its nominal self: what a controller is not told.
struct PlantDeviation {
  double friction_scale = 1.0;  ///< all tyre forces times this; (0, 2]
  double mass_scale = 1.0;      ///< mass and yaw inertia of the body times this; [0.5, 2]
};

/// "udacity" (the original simulator's car) or "road-car". kNotFound for another name, kInvalidArgument for a
/// deviation out of range.
[[nodiscard]] Result<std::unique_ptr<Plant>> make_plant(std::string_view name,
                                                        const PlantDeviation& deviation = {});

}  // namespace chicane::sim
