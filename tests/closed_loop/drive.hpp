// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

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

inline double top_mph(const telemetry::RunSummary& run) { return mps_to_mph(run.total.top_speed); }

}  // namespace chicane::run
