// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "chicane/base/option.hpp"
#include "chicane/base/result.hpp"
#include "chicane/sim/double_track.hpp"
#include "chicane/sim/plant.hpp"

namespace chicane::sim {

/// A simulated car that can be chosen by name.
struct PlantKind {
  std::string_view name;     ///< "road-car": small letters and dashes
  std::string_view meaning;  ///< meaning for `chicane list plants`
  std::unique_ptr<Plant> (*make)(const DoubleTrackParams&) = nullptr;
};

/// The plants that ship; files, command line and messages know these.
[[nodiscard]] std::span<const PlantKind> plants() noexcept;
/// Their names, in the same order.
[[nodiscard]] std::span<const std::string_view> plant_names() noexcept;

/// The fields of PlantDeviation with their ranges, for files and messages.
[[nodiscard]] std::span<const Option> deviation_options() noexcept;

/// The plant of that name; `params`: of `double-track`, no other has any. kNotFound "plant: got boat,
/// expected one of ..." for another name, kInvalidArgument for a deviation or a parameter out of range.
[[nodiscard]] Result<std::unique_ptr<Plant>> make_plant(std::string_view name,
                                                        const PlantDeviation& deviation = {},
                                                        const DoubleTrackParams& params = {});

}  // namespace chicane::sim
