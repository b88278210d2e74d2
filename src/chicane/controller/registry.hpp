// SPDX-License-Identifier: MIT
// Controllers of the program, by which all else finds them.
#pragma once

#include "chicane/controller/baselines.hpp"
#include "chicane/controller/controller_list.hpp"
#include "chicane/controller/cubic_mpc.hpp"
#include "chicane/controller/tracking_mpc.hpp"

namespace chicane::controller {

/// Controllers of the program. A new one is a line here and its include.
using Registry = ControllerList<TrackingMpcEntry,  //
                                CubicMpcEntry,     //
                                PidEntry,          //
                                PurePursuitEntry,  //
                                StanleyEntry>;

}  // namespace chicane::controller
