// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "chicane/base/result.hpp"
#include "options.hpp"

namespace chicane::apps {

/// Writes what a log of another program says of a car as a recording into `output`: where it was, its speed,
/// commands sent. Laps and the place along the road are those of --track; without it laps end where the car
/// has been before. Values that the log lacks stay unknown (NaN). Sentences on stderr tell how it was read.
///
/// kParse for what is no log: neither a bag of ROS 2 with odometry, nor a CSV table of a car.
[[nodiscard]] Result<void> convert_foreign_log(const std::string& file, const Options& options,
                                               const std::string& output);

}  // namespace chicane::apps
