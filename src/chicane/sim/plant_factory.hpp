// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/sim/plant.hpp"

namespace chicane::sim {

/// "udacity" (the original simulator's car) or "road-car". kNotFound for another name, kInvalidArgument for a
/// deviation out of range.
[[nodiscard]] Result<std::unique_ptr<Plant>> make_plant(std::string_view name,
                                                        const PlantDeviation& deviation = {});

}  // namespace chicane::sim
