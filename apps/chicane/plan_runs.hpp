// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/sweep/plan.hpp"
#include "chicane/sweep/sweep.hpp"

namespace chicane::apps {

/// The runs of a command: a plan, and what drives each of them.
struct PlanRuns {
  sweep::Plan plan;
  sweep::RunRule rule{};      ///< empty: as a sweep does
  const char* what = "runs";  ///< the word for what is counted
  bool keeps_failed = false;  ///< a run that cannot be driven is a line with the reason, and no failure
};

/// Their lines by number; those that were stopped are missing.
struct RunLines {
  std::map<std::uint64_t, protocol::Json> lines;
  sweep::Progress progress;
};

/// Drives them with `jobs` threads, 0: as many as there are processors, and tells on stderr how far it is.
/// The lines are kept in `results`, where an older file is completed; empty: nowhere. Fails as
/// sweep::drive_plan() does, and with the first line of a run that cannot be driven.
[[nodiscard]] Result<RunLines> drive_runs(const PlanRuns& runs, int jobs, const std::string& results,
                                          const std::atomic<bool>& stop);

/// An axis with a value of one key in each place.
[[nodiscard]] sweep::Axis list_axis(const char* key, std::vector<std::string> list);

/// A number, or null for one that is not finite.
[[nodiscard]] protocol::Json number_or_null(double value);
/// The members of a JSON object, without its braces.
[[nodiscard]] std::string members_of(const protocol::Json& object);

}  // namespace chicane::apps
