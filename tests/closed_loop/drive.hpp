// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/base/math.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/run/closed_loop.hpp"
#include "support/runs.hpp"
#include "support/slow_tests.hpp"

namespace chicane::run {

using test::Settings;

/// What `chicane drive --fast` reports for these settings, by schema key.
inline telemetry::RunSummary drive(const Settings& settings) {
  return test::drive(test::scenario_of(settings));
}

/// Result of a run that has to end completed and without leaving the road; of a setting given twice the last
/// holds.
inline telemetry::RunSummary drive_cleanly(Settings settings, const Settings& more = {}) {
  settings.insert(settings.end(), more.begin(), more.end());
  const telemetry::RunSummary run = drive(settings);
  std::string what;
  for (const auto& [key, value] : settings) what += key + "=" + value + " ";
  if (!run.completed) throw std::runtime_error(what + "is not completed: " + run.end_reason);
  EXPECT_EQ(run.off_track_events, 0) << what;
  return run;
}

inline double top_mph(const telemetry::RunSummary& run) { return mps_to_mph(run.total.top_speed); }

}  // namespace chicane::run
