// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/lap_time/limit.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/road/track.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/racing.hpp"
#include "chicane/safety/guard_options.hpp"
#include "chicane/scenario/scenario.hpp"
#include "options.hpp"

namespace chicane::apps {

/// The experiment that the command line describes: files, settings, and the speed for whichever controller
/// drives.
[[nodiscard]] protocol::Request request_of(const Options& options);
[[nodiscard]] Result<scenario::Scenario> experiment(const Options& options);

/// Whether the command line sets `key`.
[[nodiscard]] bool has_setting(const Options& options, std::string_view key);
/// The track of --track; none without that option, because the other program knows the road.
[[nodiscard]] Result<std::optional<road::Track>> given_track(const Options& options,
                                                             const scenario::Scenario& scenario);

/// The run of an experiment, ready to start, or why it cannot be driven: `drive` starts it, `check` only
/// asks. `hooks`: while its lap is planned.
[[nodiscard]] Result<std::unique_ptr<run::ClosedLoop>> prepared(const protocol::Request& request);
[[nodiscard]] Result<std::unique_ptr<run::ClosedLoop>> prepared(const scenario::Scenario& scenario,
                                                                const run::PlanHooks& hooks);

/// One sentence on what these options of the guard leave open; empty where it guards with its defaults' aims.
[[nodiscard]] std::string guard_notice(const safety::GuardOptions& guard);

/// Prints guard_notice() to stderr, once, at the start of a run; nothing with --json.
void print_guard_notice(const Options& options, const safety::GuardOptions& guard);

/// Prints the scenario's notices to stderr, a line each, at the start of a run: also with --json.
void print_notices(const scenario::Scenario& scenario);

struct LimitQuestion {
  bool wants_witness = true;
  double budget = 600.0;  ///< limit of work; the best lap so far is the answer then [s]
};

/// Limit of an experiment's plant, searched while the caller waits; reports progress on stderr. `wall_time`
/// gets the duration [s]. Fails as run::limit_of() does; `wants_stop` ends the search.
[[nodiscard]] Result<lap_time::PlantLimit> limit_of(const scenario::Scenario& scenario,
                                                    const road::Track& track, const LimitQuestion& question,
                                                    const std::atomic<bool>& wants_stop, double& wall_time);

/// Names of track and car of a limit, and the time of the search.
struct LimitRun {
  std::string track, car;
  double wall_time = 0.0;  ///< [s]
};

[[nodiscard]] std::string to_table(const LimitRun& run, const lap_time::PlantLimit& limit);
/// One JSON object (docs/reference/cli.md).
[[nodiscard]] std::string to_json(const LimitRun& run, const lap_time::PlantLimit& limit);
/// The line of the witness, which was driven, or else of the bound: the columns of a track first, so that it
/// can be driven on, then the whole motion of the car (road::RacingLinePoint).
[[nodiscard]] std::string to_csv(const LimitRun& run, const road::Track& track,
                                 const lap_time::PlantLimit& limit);

}  // namespace chicane::apps
