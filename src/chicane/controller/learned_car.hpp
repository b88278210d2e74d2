// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

namespace chicane::controller {

/// A quantity that is estimated while the car drives.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();      ///< NaN: not estimated
  double deviation = std::numeric_limits<double>::quiet_NaN();  ///< standard deviation
};

/// What a run has found out about its car, over what was told: as estimated after the last measurement. What
/// is driven with follows in steps (docs/identification.md).
struct LearnedCar {
  Estimate delay;   ///< by which commands act later than told [s]
  Estimate gain;    ///< of the steering: wheels turn to gain · command + offset
  Estimate offset;  ///< [rad]
  Estimate grip;    ///< of the tyres, share of the told one
};

}  // namespace chicane::controller
