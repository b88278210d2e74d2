// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "chicane/base/option.hpp"
#include "chicane/base/result.hpp"
#include "chicane/sim/double_track.hpp"
#include "chicane/sim/plant.hpp"

/// The simulated cars by name.

namespace chicane::sim {

/// Entry of a plant that can be chosen by name.
struct PlantKind {
  std::string_view name;     ///< small letters and dashes, for example "road-car"
  std::string_view meaning;  ///< one line for `chicane list plants`
  /// Makes the plant; only `double-track` uses the parameters.
  std::unique_ptr<Plant> (*make)(const DoubleTrackParams&) = nullptr;
};

/// The plants that ship, for files, command line and messages.
[[nodiscard]] std::span<const PlantKind> plants() noexcept;
/// Names of plants(), in the same order.
[[nodiscard]] std::span<const std::string_view> plant_names() noexcept;

/// The fields of PlantDeviation with their ranges, for files and messages.
[[nodiscard]] std::span<const Option> deviation_options() noexcept;

/// Makes the plant of that name; only `double-track` uses `params`. Fails with kNotFound "plant: got boat,
/// expected one of ..." for an unknown name, kInvalidArgument for a deviation or a parameter out of range.
[[nodiscard]] Result<std::unique_ptr<Plant>> make_plant(std::string_view name,
                                                        const PlantDeviation& deviation = {},
                                                        const DoubleTrackParams& params = {});

}  // namespace chicane::sim
