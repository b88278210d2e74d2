// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

namespace chicane::controller {

/// A quantity that is estimated while the car drives.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();      ///< NaN: not estimated
  double deviation = std::numeric_limits<double>::quiet_NaN();  ///< standard deviation
};

/// Estimates of the car that a run has made by the last measurement, beyond what was told. The car is driven
/// with them in steps (docs/identification.md).
struct LearnedCar {
  Estimate delay;   ///< time by which commands act later than told [s]
  Estimate gain;    ///< steering gain: wheels turn to gain · command + offset
  Estimate offset;  ///< [rad]
  Estimate grip;    ///< grip of the tyres, share of the told one
};

}  // namespace chicane::controller
