// SPDX-License-Identifier: MIT
#include "limit_of.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <utility>

#include "chicane/live/limit_search.hpp"
#include "chicane/run/plan_cache.hpp"

namespace chicane::apps {

Result<std::shared_ptr<const lap_time::Limit>> limit_of(const scenario::Scenario& scenario,
                                                        const path::Track& track,
                                                        std::optional<double> spacing,
                                                        const std::atomic<bool>& wants_stop,
                                                        double& wall_time) {
  using Clock = std::chrono::steady_clock;
  const bool is_terminal = isatty(STDERR_FILENO) == 1;
  const auto start = Clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  double told = 0.0;
  lap_time::LimitOptions options;
  if (spacing) options.spacing = *spacing;
  options.go_on = [&](int round, double lap_time) {
    const double now = seconds();
    if (now - told >= (is_terminal ? 0.1 : 10.0)) {
      told = now;
      fmt::print(stderr, "{}limit: round {}, {:.3f} s{}", is_terminal ? "\r" : "", round, lap_time,
                 is_terminal ? "" : "\n");
    }
    return !wants_stop.load();
  };
  Result<lap_time::Limit> limit = lap_time::find_limit(track, live::limit_vehicle(scenario), options);
  wall_time = seconds();
  if (is_terminal && told > 0.0) fmt::print(stderr, "\r{:40}\r", "");
  if (!limit) return fail(limit.error());
  return std::make_shared<const lap_time::Limit>(std::move(*limit));
}

Result<lap_time::PlantLimit> plant_limit_of(const scenario::Scenario& scenario, const path::Track& track,
                                            double budget, const std::atomic<bool>& wants_stop,
                                            double& wall_time) {
  if (scenario.vehicle.scale != 1.0)
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("limit: got a model car of scale {:g}, expected one in full size",
                            scenario.vehicle.scale));
  using Clock = std::chrono::steady_clock;
  const bool is_terminal = isatty(STDERR_FILENO) == 1;
  const auto start = Clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  double told = 0.0;
  lap_time::PlantLimitOptions options{.budget = budget};
  lap_time::PlanProgress progress;
  options.on_progress = [&](const lap_time::PlanProgress& come) { progress = come; };
  options.go_on = [&](std::string_view stage, int turn, double lap_time) {
    const double now = seconds();
    if (now - told >= (is_terminal ? 0.1 : 10.0)) {
      told = now;
      const bool is_far = progress.work >= progress.expected;
      const std::string left =
          is_far ? "" : fmt::format(", about {:.0f} s left", now * (progress.expected / progress.work - 1.0));
      fmt::print(stderr, "{}limit: {}, turn {}, {:.3f} s{}{}", is_terminal ? "\r" : "", stage, turn, lap_time,
                 left, is_terminal ? "\x1b[K" : "\n");
    }
    return !wants_stop.load();
  };
  Result<lap_time::PlantLimit> limit =
      run::cached_limit(track, scenario.plant, scenario.plant_options, options, scenario.plant_params);
  wall_time = seconds();
  if (is_terminal && told > 0.0) fmt::print(stderr, "\r\x1b[K");
  return limit;
}

}  // namespace chicane::apps
