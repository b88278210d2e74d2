// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "chicane/lap_time/minimum_time.hpp"

namespace chicane::lap_time {

/// What is known of the limit of a run: the limit, or in one sentence why there is none (yet).
struct LimitAnswer {
  std::shared_ptr<const Limit> found{};  ///< null: not known
  std::string why_not{};                 ///< empty when it is, or when no reason is known
  int first_lap = 1;  ///< it holds for laps from this one on; before, the car had other grip or mass
};

}  // namespace chicane::lap_time
