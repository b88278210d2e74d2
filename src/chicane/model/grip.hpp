// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/model/vehicle.hpp"

namespace chicane::model {

/// The same car on another surface: its tyres give `share` of their forces at the same slip. Pre: share > 0.
[[nodiscard]] inline VehicleParams with_grip(VehicleParams car, double share) {
  car.friction *= share;
  car.cornering_front *= share;
  car.cornering_rear *= share;
  return car;
}

}  // namespace chicane::model
