// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <optional>
#include <utility>

#include "chicane/run/make.hpp"
#include "chicane/run/plan_cache.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "external_run.hpp"
#include "interrupt.hpp"

namespace chicane::apps {
namespace {

/// The road of the simulator, where the command line says which; none where it does not.
Result<std::optional<road::Track>> chosen_track(const Options& options, const scenario::Scenario& scenario) {
  const bool is_given = std::any_of(options.settings.begin(), options.settings.end(),
                                    [](const auto& setting) { return setting.first == "track"; });
  if (!is_given) return std::optional<road::Track>{};
  Result<road::Track> track = run::make_track(scenario);
  if (!track) return fail(track.error());
  return std::optional<road::Track>{std::move(*track)};
}

Result<wire::ServeSummary> serve_until_stopped(const Options& options) {
  static std::atomic<bool> stop{false};  // as long as signals may come
  let_interrupts_end();
  Result<scenario::Scenario> scenario = experiment(options);
  if (!scenario) return fail(scenario.error());
  Result<std::optional<road::Track>> track = chosen_track(options, *scenario);
  if (!track) return fail(track.error());
  return drive_external_car(
      options, std::move(*scenario), std::move(*track),
      [](std::uint16_t port) { return fmt::format("a simulator on port {}", port); }, stop,
      [&options](wire::ServeOptions serving, auto&&... rest) {
        serving.clock.lock_step = 1e-3 * options.lock_step_ms;
        serving.time_field = options.sim_time;
        return wire::serve(serving, std::forward<decltype(rest)>(rest)...);
      });
}

}  // namespace

ExitCode serve(const Options& options) {
  const Result<wire::ServeSummary> summary = serve_until_stopped(options);
  if (!summary && run::must_stop_planning()) {
    fmt::print(stderr, "stopped before the run began\n");
    return kRunFailed;
  }
  if (!summary) return report(summary.error());
  return print(options, *summary, "answers", "simulators");
}

}  // namespace chicane::apps
