// SPDX-License-Identifier: MIT
// Runs with another program at the other end, in whatever protocol: the commands `serve`, `simulate` and
// `ros`.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/live/served_run.hpp"
#include "chicane/road/track.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/wire/simulate.hpp"
#include "options.hpp"

namespace chicane::apps {

/// Drives a car that another program simulates with the controller of `scenario`, until `stop`. Records the
/// run, and shows it on the terminal and in the dashboard. Without a track the road comes from the simulator.
/// `partner`: end of "default (tracking-mpc) waits for ...", for the port of the dashboard. `stop`: set by
/// Ctrl-C; static or a variable of main().
[[nodiscard]] Result<wire::ServeSummary> drive_external_car(
    const Options& options, scenario::Scenario scenario, std::optional<road::Track> track,
    const std::function<std::string(std::uint16_t)>& partner, std::atomic<bool>& stop,
    const live::ServeFunction& serve = wire::serve);
/// Prints results on stdout, and a sentence like "5 answers to 1 simulators; ..." on stderr, with the nouns
/// `answers` and `partners`.
ExitCode print(const Options& options, const wire::ServeSummary& summary, std::string_view answers,
               std::string_view partners);

/// Function that simulates the car of a scenario on a road, and calls the hooks.
using SimulateFunction = std::function<Result<wire::SimulateReport>(
    const scenario::Scenario& scenario, const road::Track& track, const wire::SimulateHooks& hooks)>;
/// Options of drive_by_external().
struct ExternalController {
  bool wants_limit = true;  ///< searches the limit during the run, and compares the laps with it
  /// Text for the terminal before the run; empty: none.
  std::function<std::string(const scenario::Scenario&, const road::Track&)> on_start{};
};
/// Simulates a car that another program drives. Records the run, and shows it on the terminal.
[[nodiscard]] Result<wire::SimulateReport> drive_by_external(const Options& options,
                                                             const ExternalController& external,
                                                             const std::atomic<bool>& stop,
                                                             const SimulateFunction& simulate);

}  // namespace chicane::apps
