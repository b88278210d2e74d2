// SPDX-License-Identifier: MIT
#include "chicane/sim/plant_factory.hpp"

#include <string>

#include "chicane/sim/road_car.hpp"
#include "chicane/sim/udacity_car.hpp"

namespace chicane::sim {

Result<std::unique_ptr<Plant>> make_plant(std::string_view name, const PlantDeviation& deviation) {
  if (!(deviation.friction_scale > 0.0 && deviation.friction_scale <= 2.0)) {
    return fail(
        ErrorCode::kInvalidArgument,
        "plant.friction_scale: got " + std::to_string(deviation.friction_scale) + ", expected in (0, 2]");
  }
  if (!(deviation.mass_scale >= 0.5 && deviation.mass_scale <= 2.0)) {
    return fail(ErrorCode::kInvalidArgument,
                "plant.mass_scale: got " + std::to_string(deviation.mass_scale) + ", expected in [0.5, 2]");
  }
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
