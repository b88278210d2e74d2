// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "chicane/base/vec2.hpp"
#include "chicane/model/state.hpp"

namespace chicane::controller {

/// One predicted moment.
struct PlanPoint {
  double time = 0.0;       ///< [s], clock of the run
  double x = 0.0;          ///< in W [m]
  double y = 0.0;          ///< in W [m]
  double psi = 0.0;        ///< [rad]
  double speed = 0.0;      ///< [m/s]
  model::Command command;  ///< held from this moment to the next point's
};

/// What a controller intends: predicted motion with its commands, and the line it tries to follow. Data only.
struct Plan {
  static constexpr int kCapacity = 256;
  int size = 0;                               ///< points in use; 0 = no plan
  std::array<PlanPoint, kCapacity> points{};  ///< points[0] is where the first command acts
  int reference_size = 0;
  std::array<Vec2, kCapacity> reference{};  ///< reference line in W [m]
};

}  // namespace chicane::controller
