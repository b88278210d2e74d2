// SPDX-License-Identifier: MIT
#include "limit_of.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <string_view>

#include "chicane/run/plan_cache.hpp"

namespace chicane::apps {

Result<lap_time::PlantLimit> limit_of(const scenario::Scenario& scenario, const road::Track& track,
                                      const LimitQuestion& question, const std::atomic<bool>& wants_stop,
                                      double& wall_time) {
  using Clock = std::chrono::steady_clock;
  const bool is_terminal = isatty(STDERR_FILENO) == 1;
  const auto start = Clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  double told = 0.0;
  lap_time::PlantLimitOptions options{.wants_witness = question.wants_witness, .budget = question.budget};
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
  Result<lap_time::PlantLimit> limit = run::limit_of(scenario, track, options);
  wall_time = seconds();
  if (is_terminal && told > 0.0) fmt::print(stderr, "\r\x1b[K");
  return limit;
}

}  // namespace chicane::apps
