// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/lap_time/limit.hpp"
#include "chicane/scenario/scenario.hpp"

namespace chicane::run {

/// Drives `scenario` again without each thing that keeps its laps from the limit, one at a time: latency with
/// its jitter, noise and age of the sensor, margin to the edges, reserve of grip and brakes, guard
/// (docs/limit.md, "The gap by corner"). Causes that the scenario does not have are left out.
///
/// On as many threads as there are processors; each run plans its own lap. `go_on` is asked repeatedly, by
/// these threads; false ends it with the complete runs. Fails where a run cannot be made. Deterministic.
/// Allocates.
[[nodiscard]] Result<std::vector<lap_time::LapWithout>> laps_without(const scenario::Scenario& scenario,
                                                                     const std::function<bool()>& go_on = {});

}  // namespace chicane::run
