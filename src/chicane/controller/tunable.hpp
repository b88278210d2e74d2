// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/model/vehicle.hpp"

namespace chicane::controller {

/// A controller whose settings may change while it drives: the other face of what make_…(options, vehicle)
/// returns.
template <class Options>
class Tunable {
 public:
  /// The next step() follows these settings. What was learned stays where it still means something: the map,
  /// the commands in flight, the last answer as a start. Pre: what make_… accepts, with the vehicle's name
  /// unchanged. Allocates nothing; no slower than a step that learns a new waypoint.
  virtual void configure(const Options& options, const model::VehicleParams& vehicle) noexcept = 0;

 protected:
  ~Tunable() = default;
};

}  // namespace chicane::controller
