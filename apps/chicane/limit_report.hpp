// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "chicane/lap_time/minimum_time.hpp"
#include "chicane/path/track.hpp"

namespace chicane::apps {

/// For whom and what a limit was found, and how long that took.
struct LimitRun {
  std::string track, car;
  double wall_time = 0.0;  ///< [s]
};

[[nodiscard]] std::string to_table(const LimitRun& run, const lap_time::Limit& limit);
/// One JSON object (docs/cli.md).
[[nodiscard]] std::string to_json(const LimitRun& run, const lap_time::Limit& limit);
/// The racing line as a track: its columns first, so that it can be driven on; then speed and accelerations.
[[nodiscard]] std::string to_csv(const LimitRun& run, const path::Track& track, const lap_time::Limit& limit);

}  // namespace chicane::apps
