// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/run/closed_loop.hpp"
#include "support/slow_tests.hpp"

namespace chicane::run {

using Settings = std::vector<std::pair<std::string, std::string>>;

/// What `chicane drive --fast` reports for these settings, by schema key.
inline telemetry::RunSummary drive(const Settings& settings) {
  const auto scenario = protocol::compose({.scenario_file = "", .settings = settings});
  if (!scenario) {
    ADD_FAILURE() << scenario.error().message;
    return {};
  }
  auto loop = run::ClosedLoop::create(*scenario);
  if (!loop) {
    ADD_FAILURE() << loop.error().message;
    return {};
  }
  return run::run_closed_loop(**loop);
}

inline double top_mph(const telemetry::RunSummary& run) { return mps_to_mph(run.total.top_speed); }

}  // namespace chicane::run
