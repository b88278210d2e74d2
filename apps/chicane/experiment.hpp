// SPDX-License-Identifier: MIT
// Experiment of a command line: its scenario, road and run, the notices before a run, and the limit of its
// plant.
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

/// Request of the command line: files, settings, faults, and the speed for whichever controller drives; and
/// the scenario of that request.
[[nodiscard]] protocol::Request request_of(const Options& options);
[[nodiscard]] Result<scenario::Scenario> experiment(const Options& options);

/// Whether the command line sets `key`.
[[nodiscard]] bool has_setting(const Options& options, std::string_view key);
/// Track of --track; none without that option: the other program then has the road.
[[nodiscard]] Result<std::optional<road::Track>> given_track(const Options& options,
                                                             const scenario::Scenario& scenario);

/// Run of an experiment, ready to start. Fails with the reason why it cannot be driven. `hooks`: called while
/// its lap is planned.
[[nodiscard]] Result<std::unique_ptr<run::ClosedLoop>> prepared(const protocol::Request& request);
[[nodiscard]] Result<std::unique_ptr<run::ClosedLoop>> prepared(const scenario::Scenario& scenario,
                                                                const run::PlanHooks& hooks);

/// Sentence about what a guard with these options does not prevent; empty if there is nothing to say.
[[nodiscard]] std::string guard_notice(const safety::GuardOptions& guard);

/// Prints guard_notice() on stderr, at the start of a run; nothing with --json.
void print_guard_notice(const Options& options, const safety::GuardOptions& guard);

/// Prints the notices of a scenario on stderr, a line each, at the start of a run; also with --json.
void print_notices(const scenario::Scenario& scenario);

/// Options of limit_of().
struct LimitQuestion {
  bool wants_witness = true;  ///< also drives laps that prove how close the limit is
  double budget = 600.0;      ///< limit of the work, after which the best lap so far is the answer [s]
};

/// Searches the limit of the plant of an experiment, and reports progress on stderr. `wants_stop` ends the
/// search; `wall_time` gets its duration [s]. Fails as run::limit_of() does.
[[nodiscard]] Result<lap_time::PlantLimit> limit_of(const scenario::Scenario& scenario,
                                                    const road::Track& track, const LimitQuestion& question,
                                                    const std::atomic<bool>& wants_stop, double& wall_time);

/// Names of track and car of a limit, and the time of the search.
struct LimitRun {
  std::string track, car;
  double wall_time = 0.0;  ///< [s]
};

/// Limit as text for people.
[[nodiscard]] std::string to_table(const LimitRun& run, const lap_time::PlantLimit& limit);
/// Limit as one JSON object (docs/reference/cli.md).
[[nodiscard]] std::string to_json(const LimitRun& run, const lap_time::PlantLimit& limit);
/// Line of the witness, or without one of the bound, as a CSV file: first the columns of a track, so that it
/// can be driven on, then the motion of the car (road::RacingLinePoint).
[[nodiscard]] std::string to_csv(const LimitRun& run, const road::Track& track,
                                 const lap_time::PlantLimit& limit);

}  // namespace chicane::apps
