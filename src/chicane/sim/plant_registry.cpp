// SPDX-License-Identifier: MIT
// List of the plants by name, and their making with checked parameters.
#include "chicane/sim/plant_registry.hpp"

#include <array>

#include "chicane/base/text.hpp"
#include "chicane/sim/udacity_car.hpp"

namespace chicane::sim {
namespace {

/// Entry of a plant without parameters.
template <class Car>
constexpr PlantKind plant() {
  return {Car::kName, Car::kMeaning,
          [](const DoubleTrackParams&) -> std::unique_ptr<Plant> { return std::make_unique<Car>(); }};
}

constexpr PlantKind kRoadCar{
    DoubleTrack::kRoadCar, DoubleTrack::kRoadCarMeaning,
    [](const DoubleTrackParams&) -> std::unique_ptr<Plant> { return std::make_unique<DoubleTrack>(); }};
constexpr PlantKind kDoubleTrack{DoubleTrack::kName, DoubleTrack::kMeaning,
                                 [](const DoubleTrackParams& params) -> std::unique_ptr<Plant> {
                                   return std::make_unique<DoubleTrack>(params);
                                 }};

/// The list. A new plant is a line here and its include.
constexpr std::array kPlants{
    plant<UdacityCar>(),
    kRoadCar,
    kDoubleTrack,
};

constexpr auto kNames = [] {
  std::array<std::string_view, kPlants.size()> names{};
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kPlants[i].name;
  return names;
}();

using D = PlantDeviation;
constexpr std::array kOptions{
    option<&D::friction_scale>("friction_scale", unit::kNone, 0.01, 2, "Tyre forces times this."),
    option<&D::mass_scale>("mass_scale", unit::kNone, 0.5, 2, "Mass times this."),
};

}  // namespace

std::span<const PlantKind> plants() noexcept { return kPlants; }
std::span<const std::string_view> plant_names() noexcept { return kNames; }
std::span<const Option> deviation_options() noexcept { return kOptions; }

Result<std::unique_ptr<Plant>> make_plant(std::string_view name, const PlantDeviation& deviation,
                                          const DoubleTrackParams& params) {
  if (const auto valid = check_options("plant_params", double_track_options(), &params); !valid)
    return fail(valid.error());
  if (const auto valid = check_options("plant_options", kOptions, &deviation); !valid)
    return fail(valid.error());
  for (const PlantKind& kind : kPlants) {
    if (kind.name != name) continue;
    std::unique_ptr<Plant> car = kind.make(params);
    car->deviate(deviation);
    return car;
  }
  return fail(ErrorCode::kNotFound,
              "plant: got " + printable(name) + ", expected one of " + joined(plant_names()));
}

}  // namespace chicane::sim
