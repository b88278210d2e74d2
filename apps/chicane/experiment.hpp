// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/base/result.hpp"
#include "chicane/scenario/scenario.hpp"
#include "options.hpp"

namespace chicane::apps {

/// The experiment that the command line describes: files, settings, and the speed for whichever controller
/// drives.
[[nodiscard]] Result<scenario::Scenario> experiment(const Options& options);

}  // namespace chicane::apps
