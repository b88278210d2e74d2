// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "chicane/base/result.hpp"
#include "options.hpp"

namespace chicane::apps {

/// Converts a log of another program into a recording, `output`: positions, speeds and commands of the car.
/// --track gives the road for laps and progress; without it a lap ends where the car has been before. Values
/// that the log lacks are NaN. One sentence on stderr sums up the findings.
///
/// kParse for a file that is neither a ROS 2 bag with odometry nor a CSV table of a car.
[[nodiscard]] Result<void> convert_foreign_log(const std::string& file, const Options& options,
                                               const std::string& output);

}  // namespace chicane::apps
