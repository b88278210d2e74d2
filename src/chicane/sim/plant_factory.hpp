// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "chicane/base/option.hpp"
#include "chicane/base/result.hpp"
#include "chicane/sim/plant.hpp"

namespace chicane::sim {

/// The fields of PlantDeviation with their ranges, for files and messages.
[[nodiscard]] std::span<const Option> deviation_options() noexcept;

/// "udacity" (the original simulator's car) or "road-car". kNotFound for another name, kInvalidArgument for a
/// deviation out of range.
[[nodiscard]] Result<std::unique_ptr<Plant>> make_plant(std::string_view name,
                                                        const PlantDeviation& deviation = {});

}  // namespace chicane::sim
