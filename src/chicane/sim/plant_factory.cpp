// SPDX-License-Identifier: MIT
#include "chicane/sim/plant_factory.hpp"

#include <array>
#include <string>

#include "chicane/sim/road_car.hpp"
#include "chicane/sim/udacity_car.hpp"

namespace chicane::sim {
namespace {

using D = PlantDeviation;
constexpr std::array kOptions{
    option<&D::friction_scale>("friction_scale", unit::kNone, 0.01, 2, "Tyre forces times this."),
    option<&D::mass_scale>("mass_scale", unit::kNone, 0.5, 2, "Mass times this."),
};

}  // namespace

std::span<const Option> deviation_options() noexcept { return kOptions; }

Result<std::unique_ptr<Plant>> make_plant(std::string_view name, const PlantDeviation& deviation) {
  if (const auto valid = check_options("plant_options", kOptions, &deviation); !valid)
    return fail(valid.error());
  if (name == "udacity") {
    auto car = std::make_unique<UdacityCar>();
    car->deviate(deviation);
    return car;
  }
  if (name == "road-car") {
    auto car = std::make_unique<RoadCar>();
    car->deviate(deviation);
    return car;
  }
  return fail(ErrorCode::kNotFound, "plant: got \"" + std::string(name) + "\", expected udacity or road-car");
}

}  // namespace chicane::sim
