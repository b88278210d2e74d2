// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "chicane/sweep/plan.hpp"

namespace chicane::sweep::detail {

/// Of what the presets, cars, scenarios and tracks say that a plan's runs are driven with, the defaults among
/// them: equal texts mean that a run depends on the plan and its number alone. Files that are not there count
/// by their error.
[[nodiscard]] std::string digest_of_files(const Plan& plan);

}  // namespace chicane::sweep::detail
