// SPDX-License-Identifier: MIT
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

/// Runs with another program at the other end: `serve`, `simulate` and `ros`, whatever they speak.

namespace chicane::apps {

/// The controller of `scenario` drives a car that another program simulates, until `stop`: recorded, on the
/// terminal and in the dashboard. Without a track the road comes from the simulator. `partner` completes
/// "default (tracking-mpc) waits for ...", and knows the port of the dashboard. Ctrl-C sets `stop`, a static
/// or a variable of main(), once the controller is ready.
[[nodiscard]] Result<wire::ServeSummary> drive_external_car(
    const Options& options, scenario::Scenario scenario, std::optional<road::Track> track,
    const std::function<std::string(std::uint16_t)>& partner, std::atomic<bool>& stop,
    const live::ServeFunction& serve = wire::serve);
/// Results on stdout, and a sentence like "5 answers to 1 simulators; ..." on stderr, with these two nouns.
ExitCode print(const Options& options, const wire::ServeSummary& summary, std::string_view answers,
               std::string_view partners);

/// Simulates the car of a scenario on a road, and calls the hooks.
using SimulateFunction = std::function<Result<wire::SimulateReport>(
    const scenario::Scenario& scenario, const road::Track& track, const wire::SimulateHooks& hooks)>;
struct ExternalController {
  bool wants_limit = true;  ///< searches the limit during the run, and compares its laps with it
  /// Text for the terminal before the run; empty: nothing.
  std::function<std::string(const scenario::Scenario&, const road::Track&)> on_start{};
};
/// Simulates the car for another program that drives it: recorded and on the terminal.
[[nodiscard]] Result<wire::SimulateReport> drive_by_external(const Options& options,
                                                             const ExternalController& external,
                                                             const std::atomic<bool>& stop,
                                                             const SimulateFunction& simulate);

}  // namespace chicane::apps
