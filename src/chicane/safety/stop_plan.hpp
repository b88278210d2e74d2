// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <memory>

#include "chicane/model/state.hpp"

namespace chicane::safety {

/// One moment of a stop.
struct StopPoint {
  double time = 0.0;      ///< from which the command acts [s], clock of the run
  double distance = 0.0;  ///< driven since the plan began [m]
  double speed = 0.0;     ///< planned then [m/s]
  model::Command command;
};

/// A way to standstill on the known road, to be driven without any further measurement (docs/safety.md). Data
/// only; travels with each command to the receiver, which stops the car when commands cease.
struct StopPlan {
  static constexpr int kCapacity = 128;
  int size = 0;  ///< points in use, by rising time; 0: no plan
  std::array<StopPoint, kCapacity> points{};

  /// One more point; nothing where the plan is full.
  void add(const StopPoint& point) noexcept {
    if (size < kCapacity) points[static_cast<std::size_t>(size++)] = point;
  }
};
[[nodiscard]] inline std::unique_ptr<StopPlan> copy_of(const StopPlan& plan) {
  return std::make_unique<StopPlan>(plan);
}

}  // namespace chicane::safety
